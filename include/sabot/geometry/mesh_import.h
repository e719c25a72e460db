#ifndef sabot_geometry_mesh_import_h
#define sabot_geometry_mesh_import_h

#include "sabot/geometry/hex_mesh.h"

#include <optional>
#include <string>

namespace sabot
{
/**
 * Hexahedra from a file by deal.II's GridIn: gmsh (.msh), Abaqus (.inp), VTK
 * (.vtk); the boundary ids are the file's.
 * @param unit         length of a unit of the file's coordinates [m]
 * @param origin       where the file's origin lies [m]
 * @param material_id  only cells with this material id of the file; nothing:
 * all
 * @param path         entry that names the file, for messages
 * Throws InputError for what cannot be read, for Exodus (Debian's deal.II has
 * no reader for it) and for cells that are not hexahedra.
 */
HexMesh read_mesh(const std::string &file, const double unit,
                  const std::array<double, 3> &origin,
                  const std::optional<unsigned int> material_id,
                  const std::string &path);

/** How well shaped the cells of a mesh are. */
struct MeshQuality
{
  /** Least over cells and corners of the determinant of the three edges over
      the product of their lengths: 1 for boxes, not positive where inverted. */
  double scaled_jacobian = 1.;
  /** Largest ratio of a cell's longest to its shortest edge. */
  double aspect_ratio = 1.;
  std::array<double, 3> worst{{0., 0., 0.}}; // a corner of the first's cell [m]
  std::string text() const;
};

MeshQuality measure_quality(const HexMesh &mesh);
} // namespace sabot

#endif
