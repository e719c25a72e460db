// From VTK's cells to meshes of hexahedra.
#include "sabot/geometry/vtk_cells.h"

#include <cmath>
#include <map>

namespace sabot
{
namespace
{
// VTK's types of cells.
constexpr int poly_vertex = 2, poly_line = 4, pixel = 8, quad = 9, voxel = 11,
              hexahedron = 12;

void check(const VtkCells &grid, const MeshFile &file)
{
  const std::size_t n = grid.types.size();
  if (n == 0 || grid.offsets.size() != n + 1)
    file.refuse("it has no cells, or not as many types as cells");
  for (const double x : grid.points)
    if (!std::isfinite(x))
      file.refuse("a coordinate is no number");
  std::int64_t last = 0;
  for (const std::int64_t offset : grid.offsets)
  {
    if (offset < last || offset > std::int64_t(grid.connectivity.size()))
      file.refuse("the offsets of its cells do not ascend within the list of "
                  "their points");
    last = offset;
  }
  for (const std::int64_t point : grid.connectivity)
    if (point < 0 || point >= std::int64_t(grid.points.size() / 3))
      file.refuse("a cell has the point " + std::to_string(point) +
                  ", which is not there");
  if (!grid.ids.empty() && grid.ids.size() != n)
    file.refuse("\"" + grid.ids_name +
                "\" has not as many values as there are cells");
}
} // namespace

const std::vector<std::string> vtk_id_names = {
    "MaterialID", "material",      "Material",    "gmsh:physical",  "medit:ref",
    "cell_tags",  "CellEntityIds", "PhysicalIds", "ElementBlockIds"};

FileMesh make_file_mesh(const VtkCells &grid, const MeshFile &file)
{
  check(grid, file);
  FileMesh mesh;
  for (std::size_t i = 0; i + 2 < grid.points.size(); i += 3)
    mesh.vertices.push_back(
        {{grid.points[i], grid.points[i + 1], grid.points[i + 2]}});
  std::map<std::int64_t, FileMesh::CellSet> cells;
  std::map<std::int64_t, FileMesh::FaceSet> faces;
  for (std::size_t c = 0; c < grid.types.size(); ++c)
  {
    const std::int64_t type = grid.types[c];
    const std::vector<FileIndex> x(grid.connectivity.begin() + grid.offsets[c],
                                   grid.connectivity.begin() +
                                       grid.offsets[c + 1]);
    const double value = grid.ids.empty() ? 0. : grid.ids[c];
    const std::int64_t id = std::abs(value) < 1e15 ? std::llround(value) : 0;
    if ((type == hexahedron || type == voxel) && x.size() == 8)
    {
      const bool lies_flat = type == hexahedron;
      cells[id].cells.push_back(mesh.cells.size());
      mesh.add_cell({{x[0], x[1], x[lies_flat ? 2 : 3], x[lies_flat ? 3 : 2],
                      x[4], x[5], x[lies_flat ? 6 : 7], x[lies_flat ? 7 : 6]}},
                    c);
    }
    else if ((type == quad || type == pixel) && x.size() == 4)
      faces[id].faces.push_back(
          {{x[0], x[1], x[type == quad ? 2 : 3], x[type == quad ? 3 : 2]}});
    else if (x.size() > 3 && type != poly_line && type != poly_vertex)
    {
      ++cells[id].n_others;
      if (mesh.n_others++ == 0)
        mesh.first_other = "cell " + std::to_string(c) + " of VTK's type " +
                           std::to_string(type);
    }
  }
  if (grid.ids.empty())
    return mesh;
  for (auto &[id, set] : cells)
  {
    set.name = std::to_string(id);
    mesh.cell_sets.push_back(std::move(set));
  }
  for (auto &[id, set] : faces)
  {
    set.name = std::to_string(id);
    mesh.face_sets.push_back(std::move(set));
  }
  mesh.notes.push_back("ids are those of the array \"" + grid.ids_name + "\"");
  return mesh;
}
} // namespace sabot
