// Adds the stabilization "residual damping": takes out of the velocities, from
// time to time, what the linear functions do not see of them. With the bond
// residuals of the velocities in the present configuration,
//
//   e_NJ = v_J - v_N - L_N dx,  L_N = sum phi (v_J - v_N) (x) dx M_N^-1,
//   p_N  = sum phi (k_N e_NJ - k_J e_JN),  v_N += p_N/m_N.
//
// The error vector of G. C. Ganzenmueller, An hourglass control algorithm for
// Lagrangian Smooth Particle Hydrodynamics, arXiv:1410.7221 (Comput. Methods
// Appl. Mech. Eng. 286 (2015) 87), damped instead of resisted. To keep it, copy
// this file into source/bodies/spg/stabilization. Scene: stabilization.prm.
#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/stabilization/unstabilized.h"
#include "sabot/bodies/velocity_constraints.h"

#include <algorithm>
#include <optional>

namespace sabot
{
namespace
{
/**
 * L_N is the best fit in the weights phi, so that e is orthogonal to all linear
 * fields: p is -A v with A symmetric, positive and zero for translations and
 * rotations, and both momenta are kept. With
 *
 *   k_N = beta/4 min over N and its neighbors of m/S,  S = sum phi,
 *
 * the eigenvalues of M^-1 A lie in [0, beta] (|a - b|^2 <= 2 |a|^2 + 2 |b|^2):
 * with beta <= 1 no motion is reversed and energy is only taken. The forces are
 * those of the step without stabilization; no stiffness, no part of the stable
 * step, nothing held in bonds, so that those that fail take nothing along.
 */
class ResidualDamping : public Unstabilized
{
public:
  ResidualDamping(const double coefficient, const unsigned int interval)
      : coefficient(coefficient), interval(interval)
  {
  }
  void after_step(SpgParts &body, const unsigned int step) override;

private:
  /** k_N of the owned particles [kg]; 0 where a fit or a velocity does not
      follow the particles. Collective. */
  std::vector<double> damping(const SpgParts &body) const;

  const double coefficient;    // beta
  const unsigned int interval; // steps
};

std::vector<double> ResidualDamping::damping(const SpgParts &body) const
{
  const NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  std::vector<double> ratio(nodes.size()); // m/S [kg]
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    double S = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      S += bonds.weight[b];
    // A tied follower goes where its leader takes it.
    ratio[i] = S > 0. && !nodes.is_follower(i) ? nodes.lumped_mass[i] / S : 0.;
  }
  body.exchange.update(ratio.data());
  std::vector<double> k(nodes.n_owned);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    double least = body.approximation.lost_direction[i] ? 0. : ratio[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      least = std::min(least, ratio[bonds.neighbor[b]]);
    k[i] = 0.25 * coefficient * least;
  }
  return k;
}

/** Best fit L of the velocities around an owned particle; nothing where the
    neighbors hardly span space. */
std::optional<Mat> velocity_gradient(const SpgParts &body, const std::size_t i)
{
  const NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  Mat M = Mat::zero(), A = M;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
  {
    const std::uint32_t j = bonds.neighbor[b];
    const Vec dx = nodes.position[j] - nodes.position[i],
              dv = nodes.velocity[j] - nodes.velocity[i];
    add_outer(M, bonds.weight[b] * dx, dx);
    add_outer(A, bonds.weight[b] * dv, dx);
  }
  const double size = trace(M) / 3.;
  if (!(determinant(M) > 1e-3 * size * size * size))
    return std::nullopt;
  return A * inverse(M);
}

void ResidualDamping::after_step(SpgParts &body, const unsigned int step)
{
  if (step % interval != 0)
    return;
  NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  const std::size_t n = nodes.n_owned;
  body.exchange.update(nodes.inertia.data());
  body.exchange.update(nodes.velocity.data());
  const std::vector<double> k = damping(body);
  AlignedVector<Vec> part(bonds.n_with_ghosts(), Vec{}); // phi k e [kg m/s]
  for (std::size_t i = 0; i < n; ++i)
  {
    if (k[i] == 0.)
      continue;
    const std::optional<Mat> L = velocity_gradient(body, i);
    for (std::size_t b = bonds.begin(i); L && b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      part[b] = bonds.weight[b] * k[i] *
                (nodes.velocity[j] - nodes.velocity[i] -
                 *L * (nodes.position[j] - nodes.position[i]));
    }
  }
  bonds.update_ghosts(part.data());
  const AlignedVector<Vec> before(nodes.velocity.begin(),
                                  nodes.velocity.begin() + n);
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec impulse = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      impulse += part[b] - part[bonds.reverse[b]];
    nodes.velocity[i] += (1. / nodes.lumped_mass[i]) * impulse;
  }
  body.constraints.impose(nodes);
  for (std::size_t i = 0; i < n; ++i)
    done[i] += 0.5 * nodes.lumped_mass[i] *
               (norm_square(before[i]) - norm_square(nodes.velocity[i]));
}

const Registry<Stabilization>::Add registered(
    {"residual damping",
     "takes what the linear functions do not see out of the velocities, at "
     "intervals.",
     [](Parameters &prm)
     {
       prm.declare_entry("Residual damping coefficient", "0.2",
                         quantity(Dimension::none, 0., 1.),
                         "beta: largest part of a motion that residual damping "
                         "takes out each time.");
       prm.declare_entry("Residual damping interval", "5", integer(1),
                         "Steps between two times.");
     },
     [](const Parameters &prm, const std::string &)
     {
       const double beta = get_quantity(prm, "Residual damping coefficient");
       const unsigned int interval =
           prm.get_integer("Residual damping interval");
       return [=] { return std::make_unique<ResidualDamping>(beta, interval); };
     }});
} // namespace
} // namespace sabot
