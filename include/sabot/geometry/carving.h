#ifndef sabot_geometry_carving_h
#define sabot_geometry_carving_h

#include "sabot/geometry/hex_mesh.h"

#include <optional>
#include <string>

namespace sabot
{
/** A box along the axes, or a cylinder along one of them: where a zone of
    particles lies, in the reference configuration. */
struct ZoneShape
{
  std::array<double, 3> center{{0., 0., 0.}}; // [m]
  std::array<double, 3> size{{0., 0., 0.}};   // [m], of a cylinder's bounds
  std::optional<int> axis;                    // of a cylinder; nothing: a box

  /** Whether the point is inside; not on the surface, to round-off. */
  bool contains(const std::array<double, 3> &point) const;
  /** Whether it is a cylinder along the @p line_axis through @p point. */
  bool is_coaxial(const unsigned int line_axis,
                  const std::array<double, 3> &point) const;
};

/** A part cut out of a FEM body for particles. */
struct Carving
{
  std::string body, zone; // names
  ZoneShape shape;
  /** Whether the particles are nodes of the body's mesh; else the body is a box
      that is meshed around the zone, and the zone has a lattice of its own. */
  bool follows_mesh = false;
  /** The particles come while the run goes on: the body keeps its cells, and
     the zone has the nodes of all of them in prospect. */
  bool finds_itself = false;
  /** Whether the shape says where particles are from the start of a zone that
      finds itself. */
  bool has_start = false;
};

/** A mesh in two parts. Nodes between them belong to both, at the same place,
    for a tie to join. */
struct CarvedMesh
{
  HexMesh rest, zone;
};

/**
 * Cuts a mesh along its faces, not along the shape: cells whose center (mean of
 * the corners) lies in @p shape form the zone. Nodes and cells keep
 * their order; faces between the parts become boundary faces of both, with the
 * first boundary id that @p n_named and the mesh leave free. Throws InputError
 * for @p path where one of the parts would be empty.
 */
CarvedMesh carve(const HexMesh &mesh, const ZoneShape &shape,
                 const unsigned int n_named, const std::string &path);
} // namespace sabot

#endif
