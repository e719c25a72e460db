#ifndef sabot_geometry_mesh_import_h
#define sabot_geometry_mesh_import_h

#include "sabot/geometry/mesh_check.h"
#include "sabot/geometry/named_mesh.h"

#include <string>

namespace sabot
{
/**
 * Hexahedra from a file of one of the formats of Registry<MeshReader>, checked
 * (mesh_check.h). Faces go by the names and numbers of the file's sets of faces
 * and nodes; 0 are those in no set.
 * Throws InputError for what cannot be read or makes no mesh of hexahedra, with
 * the line or the cell and what would help. Not collective, the same on every
 * rank.
 */
NamedMesh read_mesh(const MeshFile &file, const MeshWish &wish);

/** How well shaped the cells of a mesh are. */
struct MeshQuality
{
  /** Least over cells and corners of the determinant of the three edges over
      the product of their lengths: 1 for boxes, not positive where inverted. */
  double scaled_jacobian = 1.;
  /** Largest ratio of a cell's longest to its shortest edge. */
  double aspect_ratio = 1.;
  std::array<double, 3> worst{{0., 0., 0.}}; // a corner of the first's cell [m]
  /** Whether a cell's Jacobian is not positive inside. */
  bool is_inverted = false;
  std::string text() const;
};

MeshQuality measure_quality(const HexMesh &mesh);
} // namespace sabot

#endif
