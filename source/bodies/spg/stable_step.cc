// The stable step of particles: Gershgorin's bound, and by how much it is too
// short.
#include "sabot/bodies/spg/stable_step.h"

#include "sabot/base/exact_sum.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"

#include <Eigen/Dense>

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

/** Sums over J of V_J sum |g_J| |g_JI|: rows of K over rho c^2 [1/m]. */
std::vector<double> gradient_row_sums(const SpgParts &body)
{
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const ParticleApproximation &functions = body.approximation;
  const Vec *const X = body.fields.kernel_reference_position.data();
  AlignedVector<Mat> inverse_moment(body.nodes.size());
  struct Share
  {
    double gradient_sum, volume;
  };
  std::vector<Share> share(body.nodes.size());
  const auto bond_gradient = [&](const std::size_t i, const std::size_t b)
  {
    return functions.gradient(b, bonds.weight[b], functions.moment_inverse[i],
                              X[bonds.neighbor[b]] - X[i]);
  };
  for (std::size_t i = 0; i < n; ++i)
  {
    inverse_moment[i] = functions.moment_inverse[i];
    double sum = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec g = bond_gradient(i, b);
      self -= g;
      sum += norm(g);
    }
    share[i] = {sum + norm(self), body.fields.kernel_reference_volume[i]};
  }
  body.exchange.update(inverse_moment.data());
  body.exchange.update(share.data());
  std::vector<double> rows(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    double row = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      self -= bond_gradient(i, b);
      const double there =
          functions.stores_gradients()
              ? norm(functions.shape_gradient[bonds.reverse[b]])
              : bonds.weight[b] * norm(inverse_moment[j] * (X[j] - X[i]));
      row += share[j].volume * share[j].gradient_sum * there;
    }
    rows[i] = row + share[i].volume * share[i].gradient_sum * norm(self);
  }
  return rows;
}
} // namespace

void SpgStableStep::estimate(const SpgParts &body, const Stabilization &form)
{
  const NodalState &nodes = body.nodes;
  const Material &law = body.points.law();
  const double c = law.sound_speed(), modulus = law.density() * c * c;
  const std::vector<double> rows = gradient_row_sums(body);
  const std::vector<double> mass = moving_masses(nodes);
  std::vector<double> springs(nodes.n_owned, 0.);
  form.add_row_sums(body, springs);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const double omega_square = (modulus * rows[i] + springs[i]) / mass[i];
    step[i] = (!body.failure.has_cracks(i) ? factor : 1.) *
              (omega_square > 0. ? 2. / std::sqrt(omega_square)
                                 : 2. * body.kernel.local_spacing(i) / c);
  }
}

double SpgStableStep::least_bound(const SpgParts &body,
                                  MPI_Comm communicator) const
{
  double bound = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < step.size(); ++i)
    bound =
        std::min(bound, step[i] / (!body.failure.has_cracks(i) ? factor : 1.));
  MPI_Allreduce(MPI_IN_PLACE, &bound, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return bound;
}

bool SpgStableStep::calibration_is_due(const SpgParts &body,
                                       const std::size_t step_number,
                                       MPI_Comm communicator) const
{
  // By how much the bound is too short depends on the shape of the cloud: a
  // flattened foot of a Taylor bar has less room than the bar of the start.
  // Where the bound itself has moved, so may have that.
  constexpr std::size_t steps_per_calibration = 300;
  constexpr double change = 0.95;
  const double ratio = least_bound(body, communicator) / calibrated_bound;
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
  const double bound = calibrated_bound = least_bound(body, communicator);
  factor = frequency > 0. ? std::clamp(margin * 2. / (frequency * bound), 1.,
                                       initial_factor)
                          : 1.;
  if (is_first)
    initial_factor = factor;
  for (std::size_t i = 0; i < step.size(); ++i)
    if (!body.failure.has_cracks(i))
      step[i] *= factor / before;
}

void SpgStableStep::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("update stable step", step);
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
  AlignedVector<Vec> motion(nodes.size()), force(nodes.size()), now(n_owned),
      before(n_owned, Vec{}), next(n_owned);
  std::vector<double> root(n_owned);
  const auto product =
      [&](const AlignedVector<Vec> &a, const AlignedVector<Vec> &b)
  {
    ExactSum sum;
    for (std::size_t i = 0; i < n_owned; ++i)
      sum.add(dot(a[i], b[i]));
    ExactSum::reduce({&sum}, communicator);
    return sum.value();
  };
  start_lanczos(nodes, now, root);
  const double size = std::sqrt(product(now, now));
  for (Vec &v : now)
    v /= size;
  std::vector<double> diagonal, off_diagonal;
  // Eigenvalues in units of (c / spacing)^2 keep the exact sums in range.
  const double scale =
      std::pow(body.kernel.mean_spacing() / body.points.law().sound_speed(), 2);
  for (unsigned int k = 0; k < n; ++k)
  {
    for (std::size_t i = 0; i < n_owned; ++i)
      motion[i] = root[i] * now[i];
    body.exchange.update(motion.data());
    form.apply_linearized(body, motion, force);
    for (std::size_t i = 0; i < n_owned; ++i)
      next[i] = -scale * root[i] * force[i];
    const double alpha = product(now, next);
    diagonal.push_back(alpha);
    const double last = off_diagonal.empty() ? 0. : off_diagonal.back();
    for (std::size_t i = 0; i < n_owned; ++i)
      next[i] -= alpha * now[i] + last * before[i];
    const double beta = std::sqrt(product(next, next));
    if (!(beta > 1e-9) || k + 1 == n)
      break;
    off_diagonal.push_back(beta);
    before.swap(now);
    for (std::size_t i = 0; i < n_owned; ++i)
      now[i] = next[i] / beta;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  const Eigen::Index m = diagonal.size();
  solver.computeFromTridiagonal(
      Eigen::Map<const Eigen::VectorXd>(diagonal.data(), m),
      Eigen::Map<const Eigen::VectorXd>(off_diagonal.data(), m - 1),
      Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0., solver.eigenvalues()[m - 1]) / scale);
}
} // namespace sabot
