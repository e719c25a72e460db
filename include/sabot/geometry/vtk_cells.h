#ifndef sabot_geometry_vtk_cells_h
#define sabot_geometry_vtk_cells_h

#include "sabot/geometry/file_mesh.h"

namespace sabot
{
/** An unstructured grid as VTK's formats have it. */
struct VtkCells
{
  std::vector<double> points; // x, y, z of each
  /** Cell c has the points connectivity[offsets[c]] to offsets[c + 1]. */
  std::vector<std::int64_t> offsets, connectivity, types;
  std::vector<double> ids; // of the cells; none: empty
  std::string ids_name;    // of the array that they are from
};

/** Names of arrays of cells that number parts, as programs call them, the first
    that is there counts. */
extern const std::vector<std::string> vtk_id_names;

/** Hexahedra and voxels become cells, quadrilaterals and pixels faces, the ids
    names of both. Refuses what does not fit: offsets that do not ascend, points
    that are not there. */
FileMesh make_file_mesh(const VtkCells &grid, const MeshFile &file);
} // namespace sabot

#endif
