#include "sabot/bodies/spg/spg_body.h"

#include <Eigen/Cholesky>

namespace sabot
{
/**
 * velocity <- velocity - smoothed velocity, with
 *   smoothed_I = (1/m_I) sum_J m_J Phi_I(x_J) v_J
 * and first-order functions Phi in the present configuration: since sum_I Phi_I
 * = 1 and sum_I x_I Phi_I(x_J) = x_J, both momenta of what is taken away are
 * zero. A particle whose neighbours do not span space, or which is next to
 * tied followers (their leaders move them), keeps what it has.
 */
void SpgBody::smoothing_difference(AlignedVector<Vec> &velocity,
                                   AlignedVector<Vec> &contribution) const
{
  const std::size_t n = nodal_state.n_owned;
  AlignedVector<Vec> smoothed(n);
  for (std::size_t j = 0; j < n; ++j)
  {
    const Vec momentum = nodal_state.lumped_mass[j] * velocity[j];
    // Phi_I(x_J) = phi (1, dx) . M^-1 (1, 0), the own weight that of the
    // spline at zero.
    Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
    M(0, 0) = 2. / 3.;
    bool is_free = nodal_state.inertia[j] > 0.;
    for (std::size_t b = bonds.begin(j); b < bonds.end(j); ++b)
    {
      const Vec dx =
          (1. / mean_spacing) *
          (nodal_state.position[bonds.neighbor[b]] - nodal_state.position[j]);
      const Eigen::Vector4d p(1., dx[0], dx[1], dx[2]);
      M += bonds.weight[b] * p * p.transpose();
      is_free = is_free && nodal_state.inertia[bonds.neighbor[b]] > 0.;
    }
    const Eigen::LDLT<Eigen::Matrix4d> factors(M);
    const bool spans = is_free && !weak[j] &&
                       factors.info() == Eigen::Success &&
                       factors.rcond() > 1e-6;
    const Eigen::Vector4d a =
        spans ? Eigen::Vector4d(factors.solve(Eigen::Vector4d::Unit(0)))
              : Eigen::Vector4d(1.5, 0., 0., 0.);
    smoothed[j] = (2. / 3. * a[0]) * momentum;
    for (std::size_t b = bonds.begin(j); b < bonds.end(j); ++b)
    {
      const Vec dx =
          (1. / mean_spacing) *
          (nodal_state.position[bonds.neighbor[b]] - nodal_state.position[j]);
      const double value =
          bonds.weight[b] * (a[0] + a[1] * dx[0] + a[2] * dx[1] + a[3] * dx[2]);
      contribution[b] = spans ? value * momentum : Vec{};
    }
  }
  bonds.update_ghosts(contribution.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec sum = smoothed[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      sum += contribution[bonds.reverse[b]];
    velocity[i] -= (1. / nodal_state.lumped_mass[i]) * sum;
  }
}

void SpgBody::smooth_velocities()
{
  // Momentum-consistent smoothing applied to what the first pass took out:
  // long waves lose of the order (k h)^4 instead of (k h)^2.
  AlignedVector<Vec> difference(nodal_state.velocity.begin(),
                                nodal_state.velocity.begin() +
                                    nodal_state.n_owned);
  AlignedVector<Vec> contribution(bonds.n_with_ghosts(), Vec{});
  node_exchange.update(nodal_state.inertia.data());
  smoothing_difference(difference, contribution);
  smoothing_difference(difference, contribution);
  const AlignedVector<Vec> before(nodal_state.velocity.begin(),
                                  nodal_state.velocity.begin() +
                                      nodal_state.n_owned);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    nodal_state.velocity[i] -= options.smoothing_coefficient * difference[i];
  constraints.impose(nodal_state);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    bond_work[i] +=
        0.5 * nodal_state.lumped_mass[i] *
        (norm_square(before[i]) - norm_square(nodal_state.velocity[i]));
}
} // namespace sabot
