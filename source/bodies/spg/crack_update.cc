// What bonds that fail change while kernels stay as they are.
#include "sabot/bodies/spg/crack_forces.h"
#include "sabot/bodies/spg/failure/release_stress.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/bodies/spg/stiffness_bound.h"

#include <algorithm>
#include <limits>

namespace sabot
{
namespace
{
/** The largest stretch of @p F or its inverse, squared, as follow_motion() has
    it; without bound where F turns a neighborhood inside out. */
double largest_stretch_of(const Mat &F)
{
  if (!(determinant(F) > 0.))
    return std::numeric_limits<double>::max();
  double stretch = 0.;
  for (const Mat &A : {F, inverse(F)})
    stretch = std::max(stretch, norm_square(A.row[0]) + norm_square(A.row[1]) +
                                    norm_square(A.row[2]) - 2.);
  return stretch;
}
} // namespace

bool SpgBody::may_update_cracks_alone(const unsigned int step) const
{
  return !kernel.is_regular_step(step) && !kernel.is_half_way(step) &&
         !options.stores_gradients() &&
         options.neighbor_policy == SpgOptions::NeighborPolicy::lagrangian &&
         !(intake && intake->is_waiting());
}

bool SpgBody::update_cracks(const unsigned int step)
{
  const std::vector<std::uint32_t> &rows = failure.marked_rows();
  std::vector<ParticleApproximation::CrackedRow> left;
  double change = 1.;
  for (const std::uint32_t i : rows)
  {
    left.push_back(approximation.without_bonds(
        bonds, fields, nodal_state.position.data(), i, failure.marks()));
    change = std::max(change, largest_stretch_of(left.back().gradient));
  }
  MPI_Allreduce(MPI_IN_PLACE, &change, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (kernel.has_changed(change))
    return false;

  CrackedParticles cracked;
  cracked.changed = open_cracks(left);
  cracked.beside.resize(nodal_state.size());
  for (const std::uint32_t i : cracked.changed)
    cracked.beside[i] = 1;
  cracked.beside = with_neighbors(parts, std::move(cracked.beside));
  stable.estimate_beside(cracked.beside, parts, *stabilization);
  const bool calibrates =
      n_global > 1 && stable.calibration_is_due(parts, step, communicator);
  if (calibrates)
    stable.calibrate(parts, *stabilization, step, !stable.is_calibrated(),
                     communicator);
  renew_forces(cracked, calibrates);
  return true;
}

std::vector<std::uint32_t>
SpgBody::open_cracks(const std::vector<ParticleApproximation::CrackedRow> &left)
{
  const std::vector<std::uint32_t> rows = failure.marked_rows(),
                                   n_failed_before = failure.n_failed;
  const std::vector<char> failed_already = failure.is_failed;
  failure.count(nodal_state, bonds, node_exchange);
  stabilization->begin_crack_update(parts, rows);
  for (const std::uint32_t i : rows)
    failure.loss[i] += stabilization->held_energy(parts, i);
  if (failure.remove_from_rows(bonds))
    stabilization->carry_rows(bonds, rows);
  bonds.settle();
  take_functions(rows, left);
  stabilization->end_crack_update(parts, rows);
  for (const std::uint32_t i : rows)
    failure.loss[i] -= stabilization->held_energy(parts, i);
  failure.judge(approximation.lost_direction, *residual_strength);
  std::vector<std::uint32_t> changed;
  auto row = rows.begin();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const bool loses_bonds = row != rows.end() && *row == i,
               fails = failure.is_failed[i] && !failed_already[i],
               cracks = n_failed_before[i] == 0 && failure.n_failed[i] > 0;
    row += loses_bonds;
    if (fails)
      release_stress(parts, i);
    if (loses_bonds || fails || cracks)
      changed.push_back(i);
  }
  return changed;
}

void SpgBody::renew_forces(const CrackedParticles &cracked, const bool of_all)
{
  const std::size_t n = nodal_state.n_owned;
  // What couplings have added stays, as at a kernel update.
  AlignedVector<Vec> added(n);
  for (std::size_t i = 0; i < n; ++i)
    added[i] = nodal_state.force[i] - fields.own_force[i];
  if (of_all || !stabilization->renew_forces(parts, cracked))
  {
    evaluate_forces(no_step);
    for (std::size_t i = 0; i < n; ++i)
      nodal_state.force[i] += added[i];
    return;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (cracked.beside[i])
    {
      fields.own_force[i] = nodal_state.force[i];
      nodal_state.force[i] += added[i];
    }
}

void SpgBody::take_functions(
    const std::vector<std::uint32_t> &rows,
    const std::vector<ParticleApproximation::CrackedRow> &left)
{
  // Other functions see another F in the same positions. That is no
  // deformation: what F since the kernel update gains F until then loses.
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const std::size_t i = rows[k];
    const Mat &F = left[k].gradient;
    Mat &F_before = fields.incremental_deformation_gradient[i];
    fields.kernel_reference_volume[i] *= determinant(F_before) / determinant(F);
    fields.kernel_reference_deformation_gradient[i] =
        inverse(F) * fields.deformation_gradient(i);
    F_before = F;
    approximation.take(i, left[k]);
  }
}
} // namespace sabot
