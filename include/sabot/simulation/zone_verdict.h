#ifndef sabot_simulation_zone_verdict_h
#define sabot_simulation_zone_verdict_h

#include "sabot/base/timers.h"
#include "sabot/simulation/scene.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/**
 * A box or cylinder of particles that replaces cells of a FEM body: where it
 * lies and which of its faces are inside that body, where the two are tied.
 * In the reference configuration [m]. A face is tied where it lies inside the
 * host's bounds by more than 1e-3 spacings; all of a cylinder's side is, where
 * any part of it is.
 */
struct ZoneBox
{
  int zone, host; // bodies
  Turn turn;      // of both; what follows is as before it
  std::array<double, 3> low, high, spacing;
  std::array<bool, 3> tied_low, tied_high;
  /** Of a cylinder with the bounds low, high; nothing: a box. */
  std::optional<int> axis;

  /** Distance of a point from the axis of a cylinder [m]. */
  double radius_of(const std::array<double, 3> &x) const;

  /**
   * Reference distance of a point to the nearest tied face in spacings;
   * negative outside the zone. Huge where nothing is tied.
   *   min over tied faces of depth/spacing,
   * depth to the plane, or radius - |x - axis| for a cylinder's side; outside
   * the zone minus the largest of the distances outside of single faces.
   */
  double distance_from_tie(const std::array<double, 3> &x) const;
};

/**
 * The zones of a scene.
 * One for each of Scene::zones, in their order. Not collective.
 */
std::vector<ZoneBox> find_zones(const Scene &scene);

/** What a zone was needed for. Boxes are in the reference configuration. */
struct ZoneVerdict
{
  std::string zone, host;
  double spacing = 0.; // [m], mean
  /** Least distance from the tie [spacings] that plastic strain above 1 % and
      broken bonds reached, huge where there were none; negative: cells so far
      outside the zone strained that much. */
  double plastic_distance, bond_distance;
  /**
   * Smallest box, of a cylinder the bounds of the smallest cylinder, with the
   * same center line that leaves two spacings between them and the tie, what it
   * holds, and what it would have saved.
   * Kept symmetric about the center where both sides are tied, as wide as
   * before where a side is free. Seconds saved may be negative: then it costs.
   */
  struct Box
  {
    std::array<double, 3> size; // [m]
    double n_particles, seconds_saved;
  };
  Box for_both, for_bonds;
  double n_particles;

  /**
   * Whether the tie held back what would have gone further: a larger zone may
   * be found too small as well.
   * Bonds or plastic strain that came as far as the tie were stopped by it or
   * went through it, and how far they would have come nobody knows.
   */
  bool is_lower_bound() const
  {
    return bond_distance <= 0. || plastic_distance <= 0.;
  }
};

/**
 * Plastic strain and broken bonds only ever grow, so the end of a run tells how
 * far they came. Seconds saved: particles left out at the measured cost of a
 * particle-step, its searches and kernel updates, less the cells that would
 * stand in their place. Collective.
 *
 * Cost of a particle: SPG step, kernel update and contact timers over the
 * number of particles; of a cell: the FEM step's over the number of cells.
 * Without steps nothing is saved. Changes nothing.
 */
std::vector<ZoneVerdict> judge_zones(const Scene &scene, const Timers &timers,
                                     const unsigned int n_steps,
                                     MPI_Comm communicator);

/** One line for the log. */
std::string describe(const ZoneVerdict &verdict);
} // namespace sabot

#endif
