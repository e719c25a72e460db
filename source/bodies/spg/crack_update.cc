// What bonds that fail change while kernels stay as they are.
#include "sabot/bodies/spg/crack_update.h"

#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/crack_forces.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/release_stress.h"
#include "sabot/bodies/spg/image_reaction.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"
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

bool CrackUpdate::may_leave_kernels(const unsigned int step) const
{
  return !body.kernel.is_regular_step(step) && !body.kernel.is_half_way(step) &&
         !approximation.stores_gradients() &&
         body.options.neighbor_policy == SpgOptions::NeighborPolicy::lagrangian;
}

CrackUpdate::Rest CrackUpdate::update(const unsigned int step)
{
  std::vector<Row> left;
  double change = 1.;
  for (const std::uint32_t i : body.failure.marked_rows())
  {
    left.push_back(approximation.without_bonds(body.bonds, body.fields,
                                               body.nodes.position.data(), i,
                                               body.failure.marks()));
    change = std::max(change, largest_stretch_of(left.back().gradient));
  }
  MPI_Allreduce(MPI_IN_PLACE, &change, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (body.kernel.has_changed(change))
    return Rest::all_kernels;

  CrackedParticles cracked;
  cracked.changed = open(left);
  cracked.beside.resize(body.nodes.size());
  for (const std::uint32_t i : cracked.changed)
    cracked.beside[i] = 1;
  cracked.beside = with_neighbors(body, std::move(cracked.beside));
  stable.estimate_beside(cracked.beside, body, form);
  if (stable.calibration_is_due(body, step, communicator))
  {
    stable.calibrate(body, form, step, !stable.is_calibrated(), communicator);
    return Rest::all_forces;
  }
  return renew_forces(cracked) ? Rest::nothing : Rest::all_forces;
}

std::vector<std::uint32_t> CrackUpdate::open(const std::vector<Row> &left)
{
  BondFailure &failure = body.failure;
  const std::vector<std::uint32_t> rows = failure.marked_rows(),
                                   n_failed_before = failure.n_failed;
  const std::vector<char> failed_already = failure.is_failed;
  failure.count(body.nodes, body.bonds, body.exchange);
  form.begin_crack_update(body, rows);
  for (const std::uint32_t i : rows)
    failure.loss[i] += form.held_energy(body, i);
  take_functions(left);
  form.end_crack_update(body, rows);
  for (const std::uint32_t i : rows)
    failure.loss[i] -= form.held_energy(body, i);
  failure.judge(approximation.lost_direction, body.residual_strength);
  std::vector<std::uint32_t> changed;
  auto row = rows.begin();
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    const bool loses_bonds = row != rows.end() && *row == i,
               fails = failure.is_failed[i] && !failed_already[i],
               cracks = n_failed_before[i] == 0 && failure.n_failed[i] > 0;
    row += loses_bonds;
    if (fails)
      release_stress(body, i);
    if (loses_bonds || fails || cracks)
      changed.push_back(i);
  }
  return changed;
}

void CrackUpdate::take_functions(const std::vector<Row> &left)
{
  const std::vector<std::uint32_t> rows = body.failure.marked_rows();
  if (body.failure.remove_from_rows(body.bonds))
    form.carry_rows(body.bonds, rows);
  body.bonds.settle();
  // Other functions see another F in the same positions. That is no
  // deformation: what F since the kernel update gains F until then loses.
  ParticleFields &fields = body.fields;
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const std::size_t i = rows[k];
    const Mat &F = left[k].gradient;
    Mat &F_before = fields.incremental_deformation_gradient[i];
    fields.kernel_reference_volume[i] *= determinant(F_before) / determinant(F);
    const Mat back = inverse(F);
    fields.kernel_reference_deformation_gradient[i] =
        back * fields.deformation_gradient(i);
    // And F H, what the kernel has become, stays.
    fields.kernel[i] = back * (F_before * fields.kernel[i]);
    F_before = F;
    approximation.take(i, left[k]);
  }
  body.exchange.update(fields.kernel.data());
}

bool CrackUpdate::renew_forces(const CrackedParticles &cracked)
{
  AlignedVector<Vec> &force = body.nodes.force, &own = body.fields.own_force;
  const std::size_t n = body.nodes.n_owned;
  AlignedVector<Vec> added(n);
  for (std::size_t i = 0; i < n; ++i)
    added[i] = force[i] - own[i];
  if (body.reaction)
    body.reaction->settle(own);
  if (!form.renew_forces(body, cracked))
    return false;
  for (std::size_t i = 0; i < n; ++i)
    if (cracked.beside[i])
    {
      own[i] = force[i];
      force[i] += added[i];
    }
  return true;
}
} // namespace sabot
