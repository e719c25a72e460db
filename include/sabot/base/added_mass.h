#ifndef sabot_base_added_mass_h
#define sabot_base_added_mass_h

#include "sabot/base/nodal_state.h"

namespace sabot
{
/** Energy [J] that @p more inertia [kg] at owned node @p i, which is no
   follower, brings after a step of @p dt [s] with the present forces f:

      1/2 dm v^2 + dt^2/8 (1/m - 1/(m + dm)) f^2,

    its own, and by how much less of v is from the last half kick, which the
    balance leaves out (Body::add_kick_energy()). @p free: 1 for the components
    that forces move, else 0. */
inline double energy_of_added_mass(const NodalState &nodes, const std::size_t i,
                                   const Vec free, const double more,
                                   const double dt)
{
  const double m = nodes.inertia[i];
  return 0.5 * more * norm_square(nodes.velocity[i]) +
         dt * dt / 8. * (1. / m - 1. / (m + more)) *
             norm_square(free * nodes.kick_force(i));
}
} // namespace sabot

#endif
