// Stabilization by smoothing velocities from time to time, momentum consistent.
#include "sabot/base/nodal_state.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/image_reaction.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/stabilization/unstabilized.h"
#include "sabot/bodies/velocity_constraints.h"

#include <Eigen/Cholesky>

namespace sabot
{
namespace
{
class VelocitySmoothing : public Unstabilized
{
public:
  VelocitySmoothing(const double coefficient, const unsigned int interval)
      : coefficient(coefficient), interval(interval)
  {
  }
  void after_step(SpgParts &body, const unsigned int step) override;

private:
  const double coefficient;    // beta
  const unsigned int interval; // steps
};

/** First-order function of a particle at itself: value and slopes a, so that
    Phi_I(x_J) = phi (1, dx) . a with dx in spacings. */
struct LinearFunction
{
  Eigen::Vector4d a;
  bool spans;
};

/** Phi_I(x_J) = phi (1, dx) . M^-1 (1, 0), the own weight that of the spline at
    zero. */
LinearFunction find_function(const SpgParts &body, const std::size_t j,
                             const double per_spacing)
{
  const NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  M(0, 0) = 2. / 3.;
  bool is_free = !nodes.is_follower(j);
  for (std::size_t b = bonds.begin(j); b < bonds.end(j); ++b)
  {
    const Vec dx =
        per_spacing * (nodes.position[bonds.neighbor[b]] - nodes.position[j]);
    const Eigen::Vector4d p(1., dx[0], dx[1], dx[2]);
    M += double(bonds.weight[b]) * p * p.transpose();
    is_free = is_free && !nodes.is_follower(bonds.neighbor[b]);
  }
  const Eigen::LDLT<Eigen::Matrix4d> factors(M);
  const bool spans = is_free && !body.approximation.lost_direction[j] &&
                     factors.info() == Eigen::Success && factors.rcond() > 1e-6;
  return {spans ? Eigen::Vector4d(factors.solve(Eigen::Vector4d::Unit(0)))
                : Eigen::Vector4d(1.5, 0., 0., 0.),
          spans};
}

/**
 * velocity <- velocity - smoothed velocity, with
 *   smoothed_I = (1/m_I) sum_J m_J Phi_I(x_J) v_J
 * and first-order functions Phi in the present configuration: since sum_I Phi_I
 * = 1 and sum_I x_I Phi_I(x_J) = x_J, both momenta of what is taken away are
 * zero. A particle whose neighbors do not span space, or which is next to
 * tied followers (their leaders move them), keeps what it has.
 */
void subtract_smoothed(const SpgParts &body, AlignedVector<Vec> &velocity,
                       AlignedVector<Vec> &contribution)
{
  const NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  const std::size_t n = nodes.n_owned;
  const double per_spacing = 1. / body.kernel.mean_spacing();
  std::vector<double> mass(n);
  for (std::size_t i = 0; i < n; ++i)
    mass[i] = nodes.moving_mass(i);
  body.exchange.make_whole(mass.data());
  AlignedVector<Vec> smoothed(n);
  for (std::size_t j = 0; j < n; ++j)
  {
    const Vec momentum = mass[j] * velocity[j];
    const LinearFunction phi = find_function(body, j, per_spacing);
    const Eigen::Vector4d &a = phi.a;
    smoothed[j] = (2. / 3. * a[0]) * momentum;
    for (std::size_t b = bonds.begin(j); b < bonds.end(j); ++b)
    {
      const Vec dx =
          per_spacing * (nodes.position[bonds.neighbor[b]] - nodes.position[j]);
      const double value =
          bonds.weight[b] * (a[0] + a[1] * dx[0] + a[2] * dx[1] + a[3] * dx[2]);
      contribution[b] = phi.spans ? value * momentum : Vec{};
    }
  }
  bonds.update_ghosts(contribution.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec sum = smoothed[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      sum += contribution[bonds.reverse[b]];
    velocity[i] -= (1. / mass[i]) * sum;
  }
}

void VelocitySmoothing::after_step(SpgParts &body, const unsigned int step)
{
  if (step % interval != 0)
    return;
  // Momentum-consistent smoothing applied to what the first pass took out:
  // long waves lose of the order (k h)^4 instead of (k h)^2.
  NodalState &nodes = body.nodes;
  const std::size_t n = nodes.n_owned;
  AlignedVector<Vec> difference(nodes.velocity.begin(),
                                nodes.velocity.begin() + n);
  AlignedVector<Vec> contribution(body.bonds.n_with_ghosts(), Vec{});
  body.exchange.update(nodes.inertia.data());
  subtract_smoothed(body, difference, contribution);
  subtract_smoothed(body, difference, contribution);
  const AlignedVector<Vec> before(nodes.velocity.begin(),
                                  nodes.velocity.begin() + n);
  for (std::size_t i = 0; i < n; ++i)
  {
    nodes.velocity[i] -= coefficient * difference[i];
    if (body.reaction)
      body.reaction->add(i,
                         -nodes.moving_mass(i) * coefficient * difference[i]);
  }
  body.constraints.impose(nodes);
  for (std::size_t i = 0; i < n; ++i)
    done[i] += 0.5 * nodes.moving_mass(i) *
               (norm_square(before[i]) - norm_square(nodes.velocity[i]));
}

const Registry<Stabilization>::Add registered(
    {"velocity smoothing",
     "takes a part of what neighbors do not share out of the velocities, at "
     "intervals.",
     [](Parameters &prm)
     {
       prm.declare_entry("Smoothing coefficient", "0.1",
                         quantity(Dimension::none, 0., 1.),
                         "Part of the doubly smoothed difference that velocity "
                         "smoothing takes out each time.");
       prm.declare_entry("Smoothing interval", "5", integer(1),
                         "Steps between velocity smoothings.");
     },
     [](const Parameters &prm, const std::string &)
     {
       const double beta = get_quantity(prm, "Smoothing coefficient");
       const unsigned int interval = prm.get_integer("Smoothing interval");
       return [=]
       { return std::make_unique<VelocitySmoothing>(beta, interval); };
     }});
} // namespace
} // namespace sabot
