#ifndef sabot_geometry_carving_h
#define sabot_geometry_carving_h

#include "sabot/geometry/hex_mesh.h"

#include <string>

namespace sabot
{
/** A box, or a cylinder along an axis: where a zone of particles lies. */
struct ZoneShape
{
  std::array<double, 3> centre{{0., 0., 0.}}; // [m]
  std::array<double, 3> size{{0., 0., 0.}};   // [m], of a cylinder's bounds
  int axis = -1;                              // of a cylinder; -1: a box

  bool contains(const std::array<double, 3> &point) const;
};

/** A mesh in two parts that share the nodes between them. */
struct CarvedMesh
{
  HexMesh rest, zone;
};

/**
 * Cells whose centre lies in @p shape form the zone. Nodes and cells keep
 * their order; faces between the parts become boundary faces of both, with the
 * first boundary id that @p n_named and the mesh leave free. Throws InputError
 * for @p path where one of the parts would be empty.
 */
CarvedMesh carve(const HexMesh &mesh, const ZoneShape &shape,
                 const unsigned int n_named, const std::string &path);
} // namespace sabot

#endif
