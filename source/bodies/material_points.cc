// The material points of a body: rotation, work and bookkeeping around the
// update of a law, the same for cells and particles.
#include "sabot/bodies/material_points.h"

#include "sabot/bodies/body_report.h"
#include "sabot/kernels/stress_update.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** For bodies that have no stress beside the stress. */
const double no_extra[max_batch_points] = {};
} // namespace

MaterialPoints::MaterialPoints(std::shared_ptr<const Material> material)
    : material(std::move(material)),
      state_variables(this->material->state_variables()),
      n_state_rows(count_states(state_variables)), rows(n_state_rows)
{
}

void MaterialPoints::allocate(const std::size_t n, const std::size_t stride)
{
  n_points = n;
  row_length = stride;
  stress.assign(n_symmetric * stride, 0.);
  state_data.resize(n_state_rows * stride);
  std::size_t row = 0;
  for (const StateVariable &variable : state_variables)
    for (int c = 0; c < (variable.is_tensor ? n_symmetric : 1); ++c, ++row)
      std::fill_n(state_data.begin() + row * stride, stride,
                  variable.initial_value);
  viscous_pressure.assign(stride, 0.);
  internal_energy.assign(stride, 0.);
  plastic_work.assign(stride, 0.);
}

void MaterialPoints::extend(const std::size_t n)
{
  const MaterialPoints old = *this;
  allocate(n, n);
  const auto copy =
      [&](const AlignedVector<double> &from, AlignedVector<double> &to)
  {
    for (std::size_t r = 0; r * n < to.size(); ++r)
      std::copy_n(from.begin() + r * old.row_length, old.n_points,
                  to.begin() + r * n);
  };
  copy(old.stress, stress);
  copy(old.state_data, state_data);
  copy(old.viscous_pressure, viscous_pressure);
  copy(old.internal_energy, internal_energy);
  copy(old.plastic_work, plastic_work);
}

void MaterialPoints::keep(const std::vector<std::size_t> &kept,
                          const std::size_t per_group, const std::size_t stride)
{
  const std::size_t old_length = row_length, n = kept.size() * per_group;
  n_points = n;
  row_length = stride;
  for (AlignedVector<double> *const array :
       {&stress, &state_data, &viscous_pressure, &internal_energy,
        &plastic_work})
  {
    const std::size_t n_rows = old_length > 0 ? array->size() / old_length : 0;
    double *const data = array->data();
    for (std::size_t r = 0; r < n_rows; ++r)
      for (std::size_t e = 0; e < kept.size(); ++e)
        for (std::size_t q = 0; q < per_group; ++q)
          data[r * stride + e * per_group + q] =
              data[r * old_length + kept[e] * per_group + q];
    array->resize(n_rows * stride);
    for (std::size_t r = 0; r < n_rows && n > 0; ++r)
      std::fill(array->begin() + r * stride + n,
                array->begin() + (r + 1) * stride,
                (*array)[r * stride + n - 1]);
  }
}

MaterialBatch MaterialPoints::rotate(const PointStep &step)
{
  MaterialBatch batch;
  batch.n = step.n;
  batch.dt = step.dt;
  for (int c = 0; c < n_symmetric; ++c)
  {
    batch.stress[c] = &stress[c * row_length + step.begin];
    batch.strain_increment[c] = step.strain[c];
  }
  for (std::size_t s = 0; s < n_state_rows; ++s)
    rows[s] = &state_data[s * row_length + step.begin];
  batch.states = rows.data();

  rotate_symmetric(step.n, step.spin, batch.stress);
  rotate_strain_to_end<max_batch_points>(step.n, step.spin, step.strain);
  std::size_t first = 0;
  for (const StateVariable &variable : state_variables)
  {
    if (variable.is_tensor)
      rotate_symmetric(step.n, step.spin, &rows[first]);
    first += variable.is_tensor ? n_symmetric : 1;
  }
  half_work(step.n, batch.stress, step.strain, step.half_volume,
            &internal_energy[step.begin]);

  batch.jacobian = step.jacobian;
  batch.extra_square =
      step.extra_square != nullptr ? step.extra_square : no_extra;
  batch.return_factor = step.return_factor;
  batch.plastic_work = step.plastic_work;
  if (material->needs_viscous_pressure())
  {
    const double *const q = &viscous_pressure[step.begin];
    for (std::size_t k = 0; k < step.n; ++k)
      step.mean_viscous_pressure[k] = 0.5 * (q[k] + step.viscous_pressure[k]);
    batch.viscous_pressure = step.mean_viscous_pressure;
  }
  if (material->needs_deformation_gradient())
    std::copy_n(step.deformation_gradient, 9, batch.deformation_gradient);
  if (material->stiffens())
    batch.stiffening = step.stiffening;
  return batch;
}

void MaterialPoints::finish(const PointStep &step)
{
  const double *now[n_symmetric];
  for (int c = 0; c < n_symmetric; ++c)
    now[c] = &stress[c * row_length + step.begin];
  double *const energy = &internal_energy[step.begin],
                *const work = &plastic_work[step.begin],
                *const q = &viscous_pressure[step.begin];
  half_work(step.n, now, step.strain, step.half_volume, energy);
#pragma GCC ivdep
  for (std::size_t k = 0; k < step.n; ++k)
  {
    energy[k] -= (q[k] + step.viscous_pressure[k]) * step.half_volume[k] *
                 (step.strain[0][k] + step.strain[1][k] + step.strain[2][k]);
    q[k] = step.viscous_pressure[k];
    work[k] += 2. * step.plastic_work[k] * step.half_volume[k];
  }
}

const double *MaterialPoints::state(const std::string &name) const
{
  return find_state(state_variables, state_data.data(), row_length, name);
}

double *MaterialPoints::state(const std::string &name)
{
  return const_cast<double *>(
      static_cast<const MaterialPoints *>(this)->state(name));
}

bool MaterialPoints::has_state(const std::string &name) const
{
  return std::any_of(state_variables.begin(), state_variables.end(),
                     [&](const StateVariable &variable)
                     { return variable.name == name; });
}

void MaterialPoints::add_to(FlowStressProbe &probe, const std::size_t point,
                            const double jacobian) const
{
  const double *const s = &stress[point];
  probe.add(-(s[0] + s[row_length] + s[2 * row_length]) / 3., jacobian,
            [&](const std::size_t row)
            { return state_data[row * row_length + point]; });
}

void MaterialPoints::add_fields(FieldList &fields,
                                const std::vector<std::size_t> &points) const
{
  add_material_fields(fields, points, row_length, stress.data(),
                      state_data.data(), state_variables);
}

void MaterialPoints::visit_state(StateVisitor &visitor, const StateItems &items,
                                 const std::size_t per_item)
{
  const auto row = [&](const std::string &name, double *const data)
  {
    visitor.visit_items(name, data, n_points / per_item, sizeof(double), items,
                        per_item, 1);
    // What pads it must be in a state that the law can update.
    if (visitor.is_restoring() && n_points > 0)
      std::fill(data + n_points, data + row_length, data[n_points - 1]);
  };
  for (int c = 0; c < n_symmetric; ++c)
    row("stress " + std::to_string(c), stress.data() + c * row_length);
  for (std::size_t r = 0; r < n_state_rows; ++r)
    row("state " + std::to_string(r), state_data.data() + r * row_length);
  row("viscous pressure", viscous_pressure.data());
  row("internal energy", internal_energy.data());
  row("plastic work", plastic_work.data());
}
} // namespace sabot
