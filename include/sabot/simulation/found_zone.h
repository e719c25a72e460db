#ifndef sabot_simulation_found_zone_h
#define sabot_simulation_found_zone_h

#include "sabot/simulation/scene.h"

#include <array>
#include <string>
#include <vector>

namespace sabot
{
/**
 * The zone that a run has made of one that finds itself: the smallest box
 * around the undeformed places of its particles, before host and zone are
 * turned, which a scene may set up from the start instead.
 */
struct FoundZone
{
  std::string zone, host;
  GlobalIndex n_particles = 0;
  std::array<double, 3> low{}, high{}; // [m]; nothing without particles
};

/** Of all growing zones of the scene. Collective. */
std::vector<FoundZone> find_grown(const Scene &scene, MPI_Comm communicator);

/** Entries of a scene with that zone fixed, in a line. */
std::string describe(const FoundZone &found);
} // namespace sabot

#endif
