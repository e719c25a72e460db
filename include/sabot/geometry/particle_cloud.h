#ifndef sabot_geometry_particle_cloud_h
#define sabot_geometry_particle_cloud_h

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/** Particles of an SPG body before it is distributed, the same on every rank,
    numbered along a space-filling curve. */
struct ParticleCloud
{
  std::vector<std::array<double, 3>> position; // [m]
  std::vector<double> volume;                  // tributary, sums to the body
  std::array<double, 3> spacing;               // per axis [m]
  /** Faces of the box a particle lies on: bits 0..5 = -x,+x,-y,+y,-z,+z. */
  std::vector<std::uint8_t> on_face;
};

/**
 * Particles on the nodes of a regular lattice over a box, faces included, as
 * in the reference paper (30 x 30 x 12.7 mm at 1.6 mm: 20 x 20 x 9 = 3600).
 * The spacing is the nearest that divides the size. Volumes are the lattice
 * cells' shares (half on faces, a quarter on edges), so mass is exact.
 */
ParticleCloud make_box_cloud(const std::array<double, 3> &centre,
                             const std::array<double, 3> &size,
                             const double nodal_spacing);

/** Number of intervals of about @p spacing in @p length, at least one. */
unsigned int n_intervals(const double length, const double spacing);
} // namespace sabot

#endif
