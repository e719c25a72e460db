#include "sabot/bodies/spg/spg_body.h"

#include "sabot/base/exact_sum.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace sabot
{
void SpgBody::estimate_stable_step()
{
  // Gershgorin bound of the largest eigenvalue of M^-1 K: row sums of
  // K_IK = sum_N V_N rho c^2 g_NI g_NK, and of the bonds' springs.
  const std::size_t n = nodal_state.n_owned;
  const double c = material->sound_speed(),
               modulus = material->density() * c * c;
  const bool stored = !shape_gradient.empty();
  AlignedVector<Mat> inverse_moment(nodal_state.size());
  struct Share
  {
    double gradient_sum, volume, stiffness;
  };
  std::vector<Share> share(nodal_state.size());
  const auto bond_gradient = [&](const std::size_t i, const std::size_t b)
  {
    return stored ? shape_gradient[b]
                  : bonds.weight[b] * (moment_inverse[i] *
                                       (kernel_position[bonds.neighbor[b]] -
                                        kernel_position[i]));
  };
  for (std::size_t i = 0; i < n; ++i)
  {
    inverse_moment[i] = moment_inverse[i];
    double sum = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec g = bond_gradient(i, b);
      self -= g;
      sum += norm(g);
    }
    share[i] = {sum + norm(self), kernel_volume[i], bond_stiffness[i]};
  }
  node_exchange.update(inverse_moment.data());
  node_exchange.update(share.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    double row = 0., springs = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      self -= bond_gradient(i, b);
      const double there =
          stored ? norm(shape_gradient[bonds.reverse[b]])
                 : bonds.weight[b] *
                       norm(inverse_moment[j] *
                            (kernel_position[j] - kernel_position[i]));
      row += share[j].volume * share[j].gradient_sum * there;
      springs += 2. * bonds.residual_weight[b] *
                 (share[i].stiffness + share[j].stiffness);
      if (second_gradient)
        for (int k = 0; k < 3; ++k)
          springs +=
              4. * modulus * share[j].volume *
              norm_square(
                  second_gradient->bond_gradient[bonds.reverse[b]].row[k]);
    }
    row += share[i].volume * share[i].gradient_sum * norm(self);
    const double mass = nodal_state.inertia[i] > 0.
                            ? nodal_state.inertia[i]
                            : nodal_state.lumped_mass[i];
    const double omega_square = (modulus * row + springs) / mass;
    update_stable_step[i] = (n_failed[i] == 0 ? step_calibration : 1.) *
                            (omega_square > 0. ? 2. / std::sqrt(omega_square)
                                               : 2. * local_spacing(i) / c);
  }
}

void SpgBody::apply_linearized(const AlignedVector<Vec> &motion,
                               AlignedVector<Vec> &force)
{
  const std::size_t n = nodal_state.n_owned;
  const double mu = material->shear_modulus(),
               lambda = material->bulk_modulus() - 2. / 3. * mu;
  const bool stored = !shape_gradient.empty();
  const Vec *const X = kernel_position.data();
  struct Particle
  {
    Mat moment, slope; // sum over bonds of what multiplies g; grad of motion
    double stiffness;
  };
  AlignedVector<Particle> particle(nodal_state.size());
  AlignedVector<Mat> inverse_moment(moment_inverse);
  inverse_moment.resize(nodal_state.size());
  node_exchange.update(inverse_moment.data());
  const auto g = [&](const std::size_t i, const std::size_t j,
                     const std::size_t bond, const double weight)
  {
    return stored ? shape_gradient[bond]
                  : weight * (inverse_moment[i] * (X[j] - X[i]));
  };
  AlignedVector<SecondGradient::Stresses> higher(
      second_gradient ? nodal_state.size() : 0);
  const auto stress = [&](const Mat &slope)
  {
    const Mat strain = 0.5 * (slope + transpose(slope));
    return 2. * mu * strain + lambda * trace(strain) * Mat::identity();
  };
  for (std::size_t i = 0; i < n; ++i)
  {
    Mat L = Mat::zero();
    Mat higher_slope[3] = {Mat::zero(), Mat::zero(), Mat::zero()};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec relative = motion[j] - motion[i];
      add_outer(L, relative, g(i, j, b, bonds.weight[b]));
      if (second_gradient)
        for (int k = 0; k < 3; ++k)
          add_outer(higher_slope[k], relative,
                    second_gradient->bond_gradient[b].row[k]);
    }
    Mat moment = kernel_volume[i] * stress(L);
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = X[j] - X[i], e = motion[j] - motion[i] - L * dX;
      add_outer(moment, -bond_stiffness[i] * bonds.residual_weight[b] * e, dX);
    }
    particle[i] = {moment, L, bond_stiffness[i]};
    if (second_gradient)
      for (int k = 0; k < 3; ++k)
        higher[i].columns[k] =
            transpose(kernel_volume[i] * stress(higher_slope[k]));
  }
  node_exchange.update(particle.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = X[j] - X[i], relative = motion[j] - motion[i];
      f += particle[i].moment * g(i, j, b, bonds.weight[b]) -
           particle[j].moment * g(j, i, bonds.reverse[b], bonds.weight[b]);
      f += bonds.residual_weight[b] *
           (particle[i].stiffness * (relative - particle[i].slope * dX) +
            particle[j].stiffness * (relative - particle[j].slope * dX));
    }
    force[i] = f;
  }
  if (second_gradient)
  {
    second_gradient->generalized_stress.swap(higher);
    second_gradient->gather(bonds, node_exchange, n, force.data());
    second_gradient->generalized_stress.swap(higher);
  }
}

double SpgBody::largest_frequency(const unsigned int n)
{
  // Lanczos iteration: the power iteration's Krylov space, of which it takes
  // the best vector. Symmetric variables y = sqrt(m) v.
  const std::size_t n_owned = nodal_state.n_owned;
  AlignedVector<Vec> motion(nodal_state.size()), force(nodal_state.size()),
      now(n_owned), before(n_owned, Vec{}), next(n_owned);
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
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    root[i] = 1. / std::sqrt(nodal_state.inertia[i] > 0.
                                 ? nodal_state.inertia[i]
                                 : nodal_state.lumped_mass[i]);
    // The start depends on a particle's number only.
    std::uint64_t bits = 0x9e3779b97f4a7c15u * (nodal_state.global_id[i] + 1);
    for (int d = 0; d < 3; ++d)
    {
      bits ^= bits >> 29;
      bits *= 0xbf58476d1ce4e5b9u;
      now[i][d] = double(bits >> 12) / double(std::uint64_t(1) << 51) - 1.;
    }
    now[i][3] = 0.;
  }
  const double size = std::sqrt(product(now, now));
  for (Vec &v : now)
    v /= size;
  std::vector<double> diagonal, off_diagonal;
  // Eigenvalues in units of (c / spacing)^2 keep the exact sums in range.
  const double scale = std::pow(mean_spacing / material->sound_speed(), 2);
  for (unsigned int k = 0; k < n; ++k)
  {
    for (std::size_t i = 0; i < n_owned; ++i)
      motion[i] = root[i] * now[i];
    node_exchange.update(motion.data());
    apply_linearized(motion, force);
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

double SpgBody::least_bound() const
{
  double bound = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    bound = std::min(bound, update_stable_step[i] /
                                (n_failed[i] == 0 ? step_calibration : 1.));
  MPI_Allreduce(MPI_IN_PLACE, &bound, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return bound;
}

bool SpgBody::calibration_is_due(const std::size_t step) const
{
  // By how much the bound is too short depends on the shape of the cloud: a
  // flattened foot of a Taylor bar has less room than the bar of the start.
  // Where the bound itself has moved, so may have that.
  constexpr std::size_t steps_per_calibration = 300;
  constexpr double change = 0.95;
  const double ratio = least_bound() / calibrated_bound;
  return step >= last_calibration + steps_per_calibration ||
         std::min(ratio, 1. / ratio) < change;
}

void SpgBody::calibrate_stable_step()
{
  // The bound is safe but 2 to 2.5 times too short for an intact cloud. How
  // much longer steps may be is measured on the whole body; particles with
  // failed bonds stay with the bound (estimate_stable_step()).
  // Central difference of nonlinear oscillators has a third-order resonance
  // at omega dt = sqrt(3) (Skeel, Zhang & Schlick 1997), seen at 1 % strain:
  // that, not the linear limit 2, is where steps end.
  constexpr unsigned int n_iterations = 30;
  constexpr double margin = 0.99 * 0.8660254037844386; // Lanczos: from below
  if (n_global < 2)
    return;
  const double frequency = largest_frequency(n_iterations);
  const double before = step_calibration;
  const double bound = calibrated_bound = least_bound();
  step_calibration = frequency > 0.
                         ? std::clamp(margin * 2. / (frequency * bound), 1.,
                                      initial_calibration)
                         : 1.;
  if (n_updates == 0)
    initial_calibration = step_calibration;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (n_failed[i] == 0)
      update_stable_step[i] *= step_calibration / before;
}
} // namespace sabot
