#ifndef sabot_geometry_round_bodies_h
#define sabot_geometry_round_bodies_h

#include "sabot/geometry/hex_mesh.h"

namespace sabot
{
/**
 * A ball of hexahedra: a bulged cube of cells in six blocks of shells, scaled
 * to the exact volume 4/3 pi r^3, so that the mass
 * is exact; the nodes of the surface then lie a little outside of the sphere.
 * Boundary id 0 everywhere but on the planes of a cut, 1 and 2.
 * @param center     [m]
 * @param cell_size  of the cells in the middle, about [m]
 * @param n_cuts     1 keeps the half where x is not less than the center's, 2
 *                   the quarter where y is not, either
 */
HexMesh make_sphere(const double radius, const std::array<double, 3> &center,
                    const double cell_size, const unsigned int n_cuts = 0);

/** Profiles of a nose of the length L on a shaft of the radius R: the radius r
    at the distance z from the shaft. */
enum class Nose
{
  conical,  // r = R (1 - z/L)
  ogive,    // tangent: r = sqrt(S^2 - z^2) - (S - R), S = (R^2 + L^2)/(2 R)
  spherical // a cap: r = sqrt(S^2 - (S - L + z)^2), S = (R^2 + L^2)/(2 L)
};

/** A cylinder with a nose. */
struct ProjectileSpecification
{
  double radius = 0., shaft_length = 0., nose_length = 0.; // [m]
  Nose nose = Nose::conical;
  unsigned int axis = 2;        // 0, 1, 2
  bool towards_positive = true; // where the nose points
  /** Middle of the whole length, on the axis [m]. */
  std::array<double, 3> center{{0., 0., 0.}};
  double cell_size = 0.;   // [m]
  unsigned int n_cuts = 0; // as of make_cylinder()
};

/**
 * Half a ball of hexahedra is stretched to the nose, its equator extruded to
 * the shaft, so that no cell degenerates at the tip. Scaled across the axis to
 * the exact volume (that of the nose by Simpson's rule). Boundary ids: 0 the
 * flat end, 1 the rest of the surface, 2 and 3 the planes of a cut. @pre A
 * tangent ogive is at least as long as its radius, a spherical nose at most.
 */
HexMesh make_projectile(const ProjectileSpecification &specification);
} // namespace sabot

#endif
