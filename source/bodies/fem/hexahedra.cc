// Material points of hexahedra, whatever the integration rule: stress, work,
// states, and what becomes of cells that would turn inside out.
#include "sabot/bodies/fem/hexahedra.h"

#include "sabot/base/error.h"
#include "sabot/bodies/body_report.h"
#include "sabot/bodies/flow_stress.h"
#include "sabot/kernels/polar.h"
#include "sabot/kernels/stress_update.h"

#include <cmath>

namespace sabot
{
namespace
{
/** Hexahedra have no stress beside the stress. */
const double no_extra[max_batch_points] = {};
/** Arrays of points end on a cache line. */
constexpr std::size_t padding = 8;
} // namespace

Hexahedra::Hexahedra(const std::string &body_name, const FemOptions &options,
                     std::shared_ptr<const Material> material,
                     const unsigned int n_points)
    : body_name(body_name), options(options), material(material),
      state_variables(material->state_variables()), n_points(n_points),
      n_states(count_states(state_variables)), batch_states(n_states)
{
}

CellConstants Hexahedra::cell_constants() const
{
  CellConstants constants;
  constants.sound_speed = material->sound_speed();
  constants.density = material->density();
  constants.mu = material->shear_modulus();
  constants.lambda = material->bulk_modulus() - 2. / 3. * constants.mu;
  constants.linear_bulk = options.bulk_viscosity_linear;
  constants.quadratic_bulk = options.bulk_viscosity_quadratic;
  return constants;
}

void Hexahedra::allocate_points()
{
  const std::size_t n = size() * n_points;
  stride = round_up(n, padding);
  stress_data.assign(6 * stride, 0.);
  state_data.resize(n_states * stride);
  std::size_t s = 0;
  for (const StateVariable &variable : state_variables)
    for (int c = 0; c < (variable.is_tensor ? n_symmetric : 1); ++c, ++s)
      std::fill_n(&state_data[s * stride], stride, variable.initial_value);
  viscous_pressure.assign(stride, 0.);
  point_energy.assign(stride, 0.);
  point_plastic_work.assign(stride, 0.);
  if (options.objective_rate == FemOptions::ObjectiveRate::green_naghdi)
    polar_rotation.assign(stride, Mat::identity());
  hourglass_energy.assign(round_up(size(), padding), 0.);
  if (options.erosion_step > 0.)
    cell_step.assign(size(), std::numeric_limits<double>::max());
}

void Hexahedra::keep_points(const std::vector<std::size_t> &kept)
{
  const auto cells = [&](auto &array)
  {
    for (std::size_t e = 0; e < kept.size(); ++e)
      array[e] = array[kept[e]];
    array.resize(kept.size());
  };
  cells(connectivity);
  cells(cell_id);
  cells(volume);
  if (!cell_step.empty())
    cells(cell_step);
  for (std::size_t e = 0; e < kept.size(); ++e)
    hourglass_energy[e] = hourglass_energy[kept[e]];
  hourglass_energy.resize(round_up(kept.size(), padding));

  const std::size_t old_stride = stride, n = kept.size() * n_points;
  stride = round_up(n, padding);
  const auto points = [&](AlignedVector<double> &array)
  {
    const std::size_t n_rows = old_stride > 0 ? array.size() / old_stride : 0;
    for (std::size_t r = 0; r < n_rows; ++r)
      for (std::size_t e = 0; e < kept.size(); ++e)
        for (std::size_t q = 0; q < n_points; ++q)
          array[r * stride + e * n_points + q] =
              array[r * old_stride + kept[e] * n_points + q];
    array.resize(n_rows * stride);
    // Fill up with a point that exists.
    for (std::size_t r = 0; r < n_rows && n > 0; ++r)
      std::fill(array.begin() + r * stride + n,
                array.begin() + (r + 1) * stride, array[r * stride + n - 1]);
  };
  points(stress_data);
  points(state_data);
  points(viscous_pressure);
  points(point_energy);
  points(point_plastic_work);
  if (!polar_rotation.empty())
  {
    for (std::size_t e = 0; e < kept.size(); ++e)
      for (std::size_t q = 0; q < n_points; ++q)
        polar_rotation[e * n_points + q] =
            polar_rotation[kept[e] * n_points + q];
    polar_rotation.resize(stride);
    if (n > 0)
      std::fill(polar_rotation.begin() + n, polar_rotation.end(),
                polar_rotation[n - 1]);
  }
}

void Hexahedra::polar_spin(const std::size_t begin, const std::size_t m,
                           PointBatch &batch)
{
  for (std::size_t k = 0; k < m; ++k)
  {
    const Mat R = rotation_of(gradient(begin + k));
    double spin[3];
    cayley_spin(R * transpose(polar_rotation[begin + k]), spin);
    for (int c = 0; c < 3; ++c)
      batch.spin[c][k] = spin[c];
    polar_rotation[begin + k] = R;
  }
}

void Hexahedra::set_deformation_gradient(const std::size_t begin,
                                         const std::size_t m,
                                         PointBatch &batch) const
{
  for (std::size_t k = 0; k < m; ++k)
  {
    Mat F = gradient(begin + k);
    // Points that share the mean volume ratio of their cell (F-bar, de Souza
    // Neto et al. 1996).
    if (n_points > 1)
      F = std::cbrt(batch.jacobian[k] / determinant(F)) * F;
    for (int c = 0; c < 9; ++c)
      batch.deformation_gradient[c][k] = F(c / 3, c % 3);
  }
}

void Hexahedra::update_points(const std::size_t begin, const std::size_t m,
                              const double dt, PointBatch &batch)
{
  if (!polar_rotation.empty())
    polar_spin(begin, m, batch);
  if (dt > 0.)
    update_stress(begin, m, dt, batch);
  const bool stiffens = dt > 0. && material->stiffens();
  const std::size_t end = std::min(begin + m, size() * n_points);
  for (std::size_t point = begin; point < end; point += n_points)
  {
    const std::size_t k = point - begin;
    double step = batch.step[k];
    if (stiffens)
      step /= std::sqrt(
          std::max(1., *std::max_element(&batch.stiffening[k],
                                         &batch.stiffening[k] + n_points)));
    note_step(point / n_points, step);
  }
}

void Hexahedra::update_stress(const std::size_t begin, const std::size_t m,
                              const double dt, PointBatch &batch)
{
  double *stress[6];
  const double *strain[6], *spin[3];
  for (int c = 0; c < 6; ++c)
  {
    stress[c] = &stress_data[c * stride + begin];
    strain[c] = batch.strain[c];
  }
  for (int c = 0; c < 3; ++c)
    spin[c] = batch.spin[c];
  for (std::size_t s = 0; s < n_states; ++s)
    batch_states[s] = &state_data[s * stride + begin];

  rotate_symmetric(m, spin, stress);
  rotate_strain_to_end(m, spin, batch.strain);
  std::size_t first = 0;
  for (const StateVariable &variable : state_variables)
  {
    if (variable.is_tensor)
      rotate_symmetric(m, spin, &batch_states[first]);
    first += variable.is_tensor ? 6 : 1;
  }
  const double *now[6] = {stress[0], stress[1], stress[2],
                          stress[3], stress[4], stress[5]};
  half_work(m, now, strain, batch.half_volume, &point_energy[begin]);
  MaterialBatch points;
  points.n = m;
  points.dt = dt;
  std::copy(strain, strain + 6, points.strain_increment);
  points.jacobian = batch.jacobian;
  std::copy(stress, stress + 6, points.stress);
  points.states = batch_states.data();
  points.extra_square = no_extra;
  points.return_factor = batch.return_factor;
  points.plastic_work = batch.plastic_work;
  if (material->needs_viscous_pressure())
  {
    for (std::size_t k = 0; k < m; ++k)
      batch.mean_viscous_pressure[k] =
          0.5 * (viscous_pressure[begin + k] + batch.viscous_pressure[k]);
    points.viscous_pressure = batch.mean_viscous_pressure;
  }
  if (material->needs_deformation_gradient())
  {
    set_deformation_gradient(begin, m, batch);
    for (int c = 0; c < 9; ++c)
      points.deformation_gradient[c] = batch.deformation_gradient[c];
  }
  if (material->stiffens())
    points.stiffening = batch.stiffening;
  material->update(points);
  half_work(m, now, strain, batch.half_volume, &point_energy[begin]);
  double *const energy = &point_energy[begin],
                *const work = &point_plastic_work[begin],
                *const q = &viscous_pressure[begin];
#pragma GCC ivdep
  for (std::size_t k = 0; k < m; ++k)
  {
    energy[k] -= (q[k] + batch.viscous_pressure[k]) * batch.half_volume[k] *
                 (batch.strain[0][k] + batch.strain[1][k] + batch.strain[2][k]);
    q[k] = batch.viscous_pressure[k];
    work[k] += 2. * batch.plastic_work[k] * batch.half_volume[k];
  }
}

bool Hexahedra::avoid_inversion(const NodalState &nodes, const std::size_t e,
                                const double J_old, const double J)
{
  using Inversion = FemOptions::Inversion;
  if (options.inversion == Inversion::erode)
  {
    inverting.push_back(e);
    return !(J > 0.); // already beyond: it rests until it goes
  }
  if (options.inversion == Inversion::shrink && J > 0.)
    return false;
  const Vec x = nodes.position[connectivity[e][0]];
  throw PhysicsError(
      "body " + body_name + ", cell " + std::to_string(cell_id[e]) + " near (" +
      std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " +
      std::to_string(x[2]) +
      ") m is about to turn inside out: one step took its volume ratio from " +
      std::to_string(J_old) + " to " + std::to_string(J) +
      "; take a smaller step factor, or set the body's \"Inversion\" to erode "
      "or shrink step");
}

void Hexahedra::reset_steps()
{
  smallest_step = StableStep();
  std::fill(cell_step.begin(), cell_step.end(),
            std::numeric_limits<double>::max());
}

Mat Hexahedra::total_stress(const std::size_t point) const
{
  const double *const s = &stress_data[point];
  const double q = viscous_pressure[point];
  return {{vec(s[0] - q, s[3 * stride], s[5 * stride]),
           vec(s[3 * stride], s[stride] - q, s[4 * stride]),
           vec(s[5 * stride], s[4 * stride], s[2 * stride] - q)}};
}

double Hexahedra::stress(const std::size_t component, const std::size_t e) const
{
  double sum = 0.;
  for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
    sum += stress_data[component * stride + q];
  return sum / n_points;
}

std::vector<double>
Hexahedra::cell_means(const AlignedVector<double> &rows) const
{
  const std::size_t n_rows = stride > 0 ? rows.size() / stride : 0;
  std::vector<double> means(n_rows * size());
  for (std::size_t r = 0; r < n_rows; ++r)
    for (std::size_t e = 0; e < size(); ++e)
    {
      double sum = 0.;
      for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
        sum += rows[r * stride + q];
      means[r * size() + e] = sum / n_points;
    }
  return means;
}

std::size_t Hexahedra::state_row(const std::string &name) const
{
  std::size_t row = 0;
  for (const StateVariable &variable : state_variables)
  {
    if (variable.name == name)
      return row;
    row += variable.is_tensor ? n_symmetric : 1;
  }
  return n_states;
}

std::vector<double> Hexahedra::cell_state(const std::string &name) const
{
  const std::size_t row = state_row(name);
  if (row == n_states)
    return {};
  std::vector<double> values(size());
  for (std::size_t e = 0; e < size(); ++e)
  {
    double sum = 0.;
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      sum += state_data[row * stride + q];
    values[e] = sum / n_points;
  }
  return values;
}

void Hexahedra::shift_state(const std::string &name,
                            const std::vector<double> &change)
{
  const std::size_t first = state_row(name) * stride;
  for (std::size_t q = 0; q < size() * n_points; ++q)
    state_data[first + q] += change[q / n_points];
}

std::vector<double>
Hexahedra::flow_stress(const std::vector<std::size_t> &some) const
{
  MaterialPoints points(*material);
  for (const std::size_t e : some)
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      points.add(-(stress_data[q] + stress_data[stride + q] +
                   stress_data[2 * stride + q]) /
                     3.,
                 determinant(gradient(q)),
                 [&](const std::size_t row)
                 { return state_data[row * stride + q]; });
  const std::vector<double> of_points = points.flow_stress();
  std::vector<double> of_cells(some.size(), 0.);
  for (std::size_t k = 0; k < of_points.size(); ++k)
    of_cells[k / n_points] += of_points[k] / n_points;
  return of_cells;
}

void Hexahedra::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("viscous pressure", viscous_pressure);
  visitor.visit_array("stress", stress_data);
  visitor.visit_array("state", state_data);
  visitor.visit_array("polar rotation", polar_rotation);
  visitor.visit_array("internal energy", point_energy);
  visitor.visit_array("hourglass energy", hourglass_energy);
  visitor.visit_array("plastic work", point_plastic_work);
  visitor.visit_value("stable step", smallest_step.dt);
  visitor.visit_value("stable step item", smallest_step.item);
}
} // namespace sabot
