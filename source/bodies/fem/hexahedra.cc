// What all integration rules share: material points, steps, reports, and what
// becomes of cells that would turn inside out.
#include "sabot/bodies/fem/hexahedra.h"

#include "sabot/base/error.h"
#include "sabot/kernels/polar.h"

#include <cmath>
#include <numeric>

namespace sabot
{
namespace
{
/** Arrays of points end on a cache line. */
constexpr std::size_t padding = 8;
} // namespace

Hexahedra::Hexahedra(const std::string &body_name, const FemOptions &options,
                     std::shared_ptr<const Material> material,
                     const unsigned int n_points)
    : body_name(body_name), options(options), material(material),
      n_points(n_points), points(material)
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

void Hexahedra::take(LocalCells cells)
{
  connectivity = std::move(cells.connectivity);
  cell_id = std::move(cells.id);
  volume.assign(round_up(size(), batch_size), 0.);
  std::copy(cells.volume.begin(), cells.volume.end(), volume.begin());
  const std::size_t n = size() * n_points;
  points.allocate(n, round_up(n, padding));
  if (options.objective_rate == FemOptions::ObjectiveRate::green_naghdi)
    polar_rotation.assign(points.stride(), Mat::identity());
  hourglass_energy.assign(round_up(size(), padding), 0.);
  if (options.mass_scaling.is_on())
    added_share.assign(size(), 0.);
  if (options.keeps_steps())
    cell_step.assign(size(), std::numeric_limits<double>::max());
}

std::array<Vec, 8> Hexahedra::corners_of(const std::size_t cell,
                                         const AlignedVector<Vec> &X) const
{
  std::array<Vec, 8> corner;
  for (int a = 0; a < 8; ++a)
    corner[a] = X[connectivity[cell][a]];
  return corner;
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
  volume.resize(round_up(kept.size(), batch_size), 0.);
  if (!cell_step.empty())
    cells(cell_step);
  if (!added_share.empty())
    cells(added_share);
  for (std::size_t e = 0; e < kept.size(); ++e)
    hourglass_energy[e] = hourglass_energy[kept[e]];
  hourglass_energy.resize(round_up(kept.size(), padding));

  const std::size_t n = kept.size() * n_points;
  points.keep(kept, n_points, round_up(n, padding));
  if (!polar_rotation.empty())
  {
    for (std::size_t e = 0; e < kept.size(); ++e)
      for (std::size_t q = 0; q < n_points; ++q)
        polar_rotation[e * n_points + q] =
            polar_rotation[kept[e] * n_points + q];
    polar_rotation.resize(points.stride());
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
  if (is_step(dt))
    update_stress(begin, m, dt, batch);
  const bool stiffens = is_step(dt) && material->stiffens();
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
  if (material->needs_deformation_gradient())
    set_deformation_gradient(begin, m, batch);
  PointStep step = batch.views(begin, m, dt);
  step.stiffening = batch.stiffening;
  material->update(points.rotate(step));
  points.finish(step);
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

double Hexahedra::stress(const std::size_t component, const std::size_t e) const
{
  double sum = 0.;
  for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
    sum += points.stress_row(component)[q];
  return sum / n_points;
}

std::vector<double>
Hexahedra::cell_means(const AlignedVector<double> &rows) const
{
  const std::size_t stride = points.stride(),
                    n_rows = stride > 0 ? rows.size() / stride : 0;
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

std::vector<double> Hexahedra::cell_state(const std::string &name) const
{
  const double *const state = points.state(name);
  if (state == nullptr)
    return {};
  std::vector<double> values(size());
  for (std::size_t e = 0; e < size(); ++e)
  {
    double sum = 0.;
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      sum += state[q];
    values[e] = sum / n_points;
  }
  return values;
}

Mat Hexahedra::mean_gradient(const std::size_t e) const
{
  Mat sum = Mat::zero();
  for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
  {
    const Mat F = gradient(q);
    for (int d = 0; d < 3; ++d)
      sum.row[d] += F.row[d] / double(n_points);
  }
  return sum;
}

void Hexahedra::mean_states(const std::size_t e, double *const values) const
{
  for (std::size_t r = 0; r < points.n_rows(); ++r)
  {
    double sum = 0.;
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      sum += points.state_row(r)[q];
    values[r] = sum / n_points;
  }
}

double Hexahedra::largest_mean(const std::size_t row,
                               const std::vector<char> &counts) const
{
  const double *const values = points.state_row(row);
  double largest = 0.;
  if (n_points == 1)
  {
    for (std::size_t e = 0; e < size(); ++e)
      largest = std::max(largest, counts[e] ? values[e] : 0.);
    return largest;
  }
  for (std::size_t e = 0; e < size(); ++e)
    if (counts[e])
      largest =
          std::max(largest, std::accumulate(values + e * n_points,
                                            values + (e + 1) * n_points, 0.) /
                                n_points);
  return largest;
}

void Hexahedra::shift_state(const std::string &name,
                            const std::vector<double> &change)
{
  double *const state = points.state(name);
  for (std::size_t q = 0; q < size() * n_points; ++q)
    state[q] += change[q / n_points];
}

std::vector<double>
Hexahedra::flow_stress(const std::vector<std::size_t> &some) const
{
  FlowStressProbe probe(*material);
  for (const std::size_t e : some)
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      points.add_to(probe, q, determinant(gradient(q)));
  const std::vector<double> of_points = probe.flow_stress();
  std::vector<double> of_cells(some.size(), 0.);
  for (std::size_t k = 0; k < of_points.size(); ++k)
    of_cells[k / n_points] += of_points[k] / n_points;
  return of_cells;
}

void Hexahedra::visit_state(StateVisitor &visitor, const StateItems &of_cells)
{
  points.visit_state(visitor, of_cells, n_points);
  visitor.visit_items("polar rotation", polar_rotation, of_cells, n_points);
  if (visitor.is_restoring() && size() > 0 && !polar_rotation.empty())
    std::fill(polar_rotation.begin() + size() * n_points, polar_rotation.end(),
              polar_rotation[size() * n_points - 1]);
  visitor.visit_items("hourglass energy", hourglass_energy, of_cells);
  visitor.visit_items("added share", added_share, of_cells);
  visitor.visit_step("stable step", smallest_step.dt, smallest_step.item);
}
} // namespace sabot
