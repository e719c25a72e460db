#ifndef sabot_geometry_round_bodies_h
#define sabot_geometry_round_bodies_h

#include "sabot/geometry/hex_mesh.h"

namespace sabot
{
/** A ball of hexahedra: a bulged cube of cells in six blocks of shells, scaled
    to the exact volume. Boundary id 0. */
HexMesh make_sphere(const double radius, const std::array<double, 3> &centre,
                    const double cell_size);

enum class Nose
{
  conical,  // r = R (1 - z/L)
  ogive,    // tangent: r = sqrt(S^2 - z^2) - (S - R), S = (R^2 + L^2)/(2 R)
  spherical // r = R sqrt(1 - (z/L)^2)
};

struct ProjectileSpecification
{
  double radius = 0., shaft_length = 0., nose_length = 0.; // [m]
  Nose nose = Nose::conical;
  unsigned int axis = 2;
  bool towards_positive = true; // where the nose points
  /** Middle of the whole length, on the axis [m]. */
  std::array<double, 3> centre{{0., 0., 0.}};
  double cell_size = 0.; // [m]
};

/** A cylinder with a nose; half a ball of hexahedra is stretched to the nose,
    its equator extruded to the shaft. Scaled across the axis to the exact
    volume. Boundary ids: 0 the flat end, 1 everything else. */
HexMesh make_projectile(const ProjectileSpecification &specification);
} // namespace sabot

#endif
