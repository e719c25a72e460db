// The stable step of particles: a bound by rows, and by how much it is too
// short.
#include "sabot/bodies/spg/stable_step.h"
#include "sabot/bodies/spg/particle_exchange.h"

#include "sabot/base/exact_sum.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stiffness_bound.h"
#include "sabot/kernels/tridiagonal.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Masses by which forces move the owned nodes; a tied follower's are its own,
    of which mass scaling's part moves with the leaders, too. */
std::vector<double> moving_masses(const NodalState &nodes)
{
  std::vector<double> masses(nodes.n_owned);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    masses[i] = nodes.moving_mass(i);
  for (std::size_t i = 0; i < nodes.added_mass.size(); ++i)
    if (nodes.is_follower(i))
      masses[i] += nodes.added_mass[i];
  return masses;
}
} // namespace

void SpgStableStep::estimate(const SpgParts &body, const Stabilization &form)
{
  estimate(body, form, std::vector<char>(body.nodes.size(), 1), true);
}

void SpgStableStep::estimate_beside_cracks(const SpgParts &body,
                                           const Stabilization &form)
{
  estimate(body, form, beside_cracks(body), true);
}

void SpgStableStep::estimate_beside(const std::vector<char> &beside,
                                    const SpgParts &body,
                                    const Stabilization &form)
{
  estimate(body, form, beside, false);
}

void SpgStableStep::carry(const ParticleFields &fields)
{
  for (std::size_t i = 0; i < step.size(); ++i)
  {
    const Mat F_inverse = inverse(fields.incremental_deformation_gradient[i]);
    double compression = -2.;
    for (const Vec row : F_inverse.row)
      compression += norm_square(row);
    step[i] /= std::sqrt(std::max(1., compression));
  }
}

void SpgStableStep::estimate(const SpgParts &body, const Stabilization &form,
                             const std::vector<char> &wanted,
                             const bool spends_stress)
{
  const NodalState &nodes = body.nodes;
  const Material &law = body.points.law();
  const double c = law.sound_speed();
  const std::vector<double> rows =
      elastic_row_bounds(body, wanted, spends_stress);
  // Rows are those of whole particles.
  std::vector<double> mass = moving_masses(nodes);
  body.exchange.make_whole(mass.data());
  std::vector<double> springs(nodes.n_owned, 0.);
  form.add_row_sums(body, springs);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    if (!wanted[i])
      continue;
    const double omega_square = (rows[i] + springs[i]) / mass[i];
    step[i] = (!body.failure.has_cracks(i) ? factor : 1.) *
              (omega_square > 0. ? 2. / std::sqrt(omega_square)
                                 : 2. * body.kernel.local_spacing(i) / c);
  }
}

SpgStableStep::Bounds SpgStableStep::least_bounds(const SpgParts &body,
                                                  MPI_Comm communicator) const
{
  double bounds[2] = {std::numeric_limits<double>::max(),
                      std::numeric_limits<double>::max()};
  for (std::size_t i = 0; i < step.size(); ++i)
    if (body.failure.has_cracks(i))
      bounds[1] = std::min(bounds[1], step[i]);
    else
      bounds[0] = std::min(bounds[0], step[i] / factor);
  MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MIN, communicator);
  return {bounds[0], bounds[1]};
}

bool SpgStableStep::calibration_is_due(const SpgParts &body,
                                       const std::size_t step_number,
                                       MPI_Comm communicator) const
{
  // By how much the bound is too short depends on the shape of the cloud: a
  // flattened foot of a Taylor bar has less room than the bar of the start.
  // Where the bound itself has moved, so may have that. Where particles with
  // cracks, which stay with the bound, have the least one, the factor of the
  // others decides nothing, and a crack more is no reason to measure.
  constexpr std::size_t steps_per_calibration = 300;
  constexpr double change = 0.95;
  const Bounds least = least_bounds(body, communicator);
  if (least.cracked < least.intact)
    return false;
  const double ratio = least.intact / calibrated_bound;
  return step_number >= last_calibration + steps_per_calibration ||
         std::min(ratio, 1. / ratio) < change;
}

void SpgStableStep::calibrate(const SpgParts &body, Stabilization &form,
                              const std::size_t step_number,
                              const bool is_first, MPI_Comm communicator)
{
  // The bound is safe but 2 to 2.5 times too short for an intact cloud. How
  // much longer steps may be is measured on the whole body; particles with
  // failed bonds stay with the bound.
  // Central difference of nonlinear oscillators has a third-order resonance
  // at omega dt = sqrt(3) (Skeel, Zhang & Schlick 1997), seen at 1 % strain:
  // that, not the linear limit 2, is where steps end.
  constexpr unsigned int n_iterations = 30;
  constexpr double margin = 0.99 * 0.8660254037844386; // Lanczos: from below
  last_calibration = step_number;
  const double frequency =
      largest_frequency(body, form, n_iterations, communicator);
  const double before = factor;
  const Bounds least = least_bounds(body, communicator);
  const double bound = std::min(least.intact, least.cracked);
  calibrated_bound = least.intact;
  factor = frequency > 0. ? std::clamp(margin * 2. / (frequency * bound), 1.,
                                       initial_factor)
                          : 1.;
  if (is_first)
    initial_factor = factor;
  for (std::size_t i = 0; i < step.size(); ++i)
    if (!body.failure.has_cracks(i))
      step[i] *= factor / before;
}

void SpgStableStep::visit_state(StateVisitor &visitor, const StateItems &items)
{
  visitor.visit_items("update stable step", step, items);
  visitor.visit_value("step calibration", factor);
  visitor.visit_value("initial calibration", initial_factor);
  visitor.visit_value("last calibration", last_calibration);
  visitor.visit_value("calibrated bound", calibrated_bound);
}

namespace
{
/** A unit vector that depends on the particles' numbers only, and
    1/sqrt(mass). */
void start_lanczos(const NodalState &nodes, AlignedVector<Vec> &now,
                   std::vector<double> &root)
{
  const std::vector<double> mass = moving_masses(nodes);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    root[i] = 1. / std::sqrt(mass[i]);
    std::uint64_t bits = 0x9e3779b97f4a7c15u * (nodes.global_id[i] + 1);
    for (int d = 0; d < 3; ++d)
    {
      bits ^= bits >> 29;
      bits *= 0xbf58476d1ce4e5b9u;
      now[i][d] = double(bits >> 12) / double(std::uint64_t(1) << 51) - 1.;
    }
    now[i][3] = 0.;
  }
}
} // namespace

double largest_frequency(const SpgParts &body, Stabilization &form,
                         const unsigned int n, MPI_Comm communicator)
{
  // Symmetric variables y = sqrt(m) v.
  const NodalState &nodes = body.nodes;
  const std::size_t n_owned = nodes.n_owned;
  // At the peak of memory: y now is motion over root, and not kept.
  AlignedVector<Vec> motion(nodes.size()), next(n_owned),
      before(n_owned, Vec{});
  std::vector<double> root(n_owned);
  const auto product = [&](const auto &dot_of)
  {
    ExactSum sum;
    for (std::size_t i = 0; i < n_owned; ++i)
      sum.add(dot_of(i));
    ExactSum::reduce({&sum}, communicator);
    return sum.value();
  };
  start_lanczos(nodes, motion, root);
  body.exchange.hold(motion.data());
  const double size = std::sqrt(
      product([&](const std::size_t i) { return dot(motion[i], motion[i]); }));
  for (std::size_t i = 0; i < n_owned; ++i)
    motion[i] *= root[i] / size;
  const auto now = [&](const std::size_t i) { return motion[i] / root[i]; };
  std::vector<double> diagonal, off_diagonal;
  // Eigenvalues in units of (c / spacing)^2 keep the exact sums in range.
  const double scale =
      std::pow(body.kernel.mean_spacing() / body.points.law().sound_speed(), 2);
  for (unsigned int k = 0; k < n; ++k)
  {
    body.exchange.update(motion.data());
    form.apply_linearized(body, motion, next);
    body.exchange.hold(next.data());
    for (std::size_t i = 0; i < n_owned; ++i)
      next[i] *= -scale * root[i];
    const double alpha =
        product([&](const std::size_t i) { return dot(now(i), next[i]); });
    diagonal.push_back(alpha);
    const double last = off_diagonal.empty() ? 0. : off_diagonal.back();
    for (std::size_t i = 0; i < n_owned; ++i)
      next[i] -= alpha * now(i) + last * before[i];
    const double beta = std::sqrt(
        product([&](const std::size_t i) { return dot(next[i], next[i]); }));
    if (!(beta > 1e-9) || k + 1 == n)
      break;
    off_diagonal.push_back(beta);
    for (std::size_t i = 0; i < n_owned; ++i)
    {
      before[i] = now(i);
      motion[i] = root[i] / beta * next[i];
    }
  }
  return std::sqrt(std::max(0., largest_eigenvalue(diagonal, off_diagonal)) /
                   scale);
}
} // namespace sabot
