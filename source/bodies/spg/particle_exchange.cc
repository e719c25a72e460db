// Ghosts and mirror images of the particles of a body.
#include "sabot/bodies/spg/particle_exchange.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/mirror_planes.h"

#include <algorithm>

namespace sabot
{
ParticleExchange::ParticleExchange(const MirrorPlanes &mirror,
                                   const NodalState &nodes,
                                   const std::vector<GlobalIndex> &ghosts,
                                   const std::vector<int> &ghost_owner,
                                   MPI_Comm communicator)
{
  n_owned = nodes.n_owned;
  std::vector<GlobalIndex> particles;
  for (std::size_t g = 0; g < ghosts.size(); ++g)
  {
    particles.push_back(MirrorPlanes::particle_of(ghosts[g]));
    const unsigned int symmetry = MirrorPlanes::symmetry_of(ghosts[g]);
    if (symmetry == 0)
      continue;
    if (const unsigned int axes = mirror.turned_axes(symmetry))
      turned.emplace_back(g, axes);
    offset.emplace_back(g, mirror.offset(symmetry));
  }
  const auto first = nodes.global_id.begin(), last = first + n_owned;
  exchange = GhostExchange(communicator, n_owned, ghost_owner, particles,
                           [&](const GlobalIndex key) {
                             return std::lower_bound(first, last, key) - first;
                           });
  for (std::size_t i = 0; i < n_owned && mirror.any(); ++i)
    if (const unsigned int on = mirror.planes_at(nodes.reference_position[i]))
      on_plane.push_back({std::uint32_t(i), MirrorPlanes::held_axes(on),
                          MirrorPlanes::copies(on)});
}
} // namespace sabot
