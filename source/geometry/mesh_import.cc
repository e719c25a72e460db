// Meshes that other programs have made: from files to bodies, and how good they
// are.
#include "sabot/geometry/mesh_import.h"

#include "sabot/base/error.h"
#include "sabot/geometry/cell_shape.h"
#include "sabot/geometry/mesh_extraction.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>

namespace sabot
{
namespace
{
/** Which sets of faces and nodes a face of the boundary is in. */
class FaceMembership
{
public:
  explicit FaceMembership(const FileMesh &mesh)
      : n_face_sets(mesh.face_sets.size()), of_node(mesh.vertices.size())
  {
    for (unsigned int s = 0; s < n_face_sets; ++s)
      for (FileFace face : mesh.face_sets[s].faces)
      {
        std::sort(face.begin(), face.end());
        of_face.push_back({face, s});
      }
    std::sort(of_face.begin(), of_face.end());
    for (unsigned int s = 0; s < mesh.node_sets.size(); ++s)
      for (const FileIndex node : mesh.node_sets[s].nodes)
        of_node[node].push_back(n_face_sets + s);
  }

  /** Ascending numbers: face sets, then node sets. */
  std::vector<unsigned int> sets_of(FileFace face) const
  {
    std::sort(face.begin(), face.end());
    std::vector<unsigned int> sets;
    for (auto at = std::lower_bound(of_face.begin(), of_face.end(),
                                    std::make_pair(face, 0u));
         at != of_face.end() && at->first == face; ++at)
      if (sets.empty() || sets.back() != at->second)
        sets.push_back(at->second);
    for (const unsigned int set : of_node[face[0]])
      if (std::all_of(face.begin(), face.end(),
                      [&](const FileIndex node)
                      {
                        return std::binary_search(of_node[node].begin(),
                                                  of_node[node].end(), set);
                      }))
        sets.push_back(set);
    return sets;
  }

private:
  const unsigned int n_face_sets;
  std::vector<std::pair<FileFace, unsigned int>> of_face;
  std::vector<std::vector<unsigned int>> of_node; // ascending
};

/** The mesh in meters, its corners in an order that suits deal.II. */
void make_triangulation(const FileMesh &mesh, const MeshWish &wish,
                        dealii::Triangulation<3> &grid)
{
  std::vector<dealii::Point<3>> vertices;
  for (const auto &x : mesh.vertices)
    vertices.emplace_back(x[0], x[1], x[2]);
  // deal.II's number of each corner, in the turn in which its own readers take
  // a cell: so files give the same bits as with these.
  constexpr unsigned int corner[8] = {2, 3, 7, 6, 0, 1, 5, 4};
  std::vector<dealii::CellData<3>> cells(mesh.cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int a = 0; a < 8; ++a)
      cells[c].vertices[corner[a]] = mesh.cells[c][a];
  dealii::GridTools::consistently_order_cells(cells);
  grid.create_triangulation(vertices, cells, dealii::SubCellData());
  dealii::GridTools::scale(wish.unit, grid);
  dealii::GridTools::shift(
      dealii::Tensor<1, 3>({wish.origin[0], wish.origin[1], wish.origin[2]}),
      grid);
}

/** One boundary id for each combination of sets that some faces are in, and the
    names of the sets; 0 is what is in none. */
void name_faces(const FileMesh &mesh, dealii::Triangulation<3> &grid,
                NamedMesh &made)
{
  for (const auto &set : mesh.face_sets)
    made.groups.push_back({set.name, set.also, {}});
  for (const auto &set : mesh.node_sets)
    made.groups.push_back({set.name, "", {}});
  const FaceMembership membership(mesh);
  std::map<std::vector<unsigned int>, unsigned int> id_of;
  made.faces.push_back("0");
  for (const auto &face : grid.active_face_iterators())
  {
    if (!face->at_boundary())
      continue;
    FileFace corners;
    for (int a = 0; a < 4; ++a)
      corners[a] = face->vertex_index(a);
    const std::vector<unsigned int> sets = membership.sets_of(corners);
    unsigned int id = 0;
    if (!sets.empty())
    {
      const auto found = id_of.emplace(sets, made.faces.size());
      id = found.first->second;
      if (found.second)
      {
        std::string name;
        for (const unsigned int s : sets)
        {
          made.groups[s].ids.push_back(id);
          name += (name.empty() ? "" : " + ") + made.groups[s].name;
        }
        made.faces.push_back(name);
      }
    }
    face->set_boundary_id(id);
  }
  made.groups.push_back({"0", "", {0}});
}

std::string names_of_faces(const NamedMesh &made)
{
  std::string all;
  int n = 0;
  constexpr int most = 12;
  for (const auto &group : made.groups)
    if (!group.ids.empty() && n++ < most)
      all += (all.empty() ? "" : ", ") + group.name +
             (group.also.empty() ? "" : " (" + group.also + ")");
  return all + (n > most ? ", ..." : "");
}
} // namespace

NamedMesh read_mesh(const MeshFile &file, const MeshWish &wish)
{
  FileMesh mesh = read_mesh_file(file);
  keep_part(mesh, file, wish);
  if (wish.joining)
    join_vertices(mesh, *wish.joining / wish.unit);
  check_mesh(mesh, file, wish);
  NamedMesh made;
  dealii::Triangulation<3> grid;
  try
  {
    make_triangulation(mesh, wish, grid);
  }
  catch (const dealii::ExceptionBase &)
  {
    file.refuse("its cells do not fit together as a mesh of hexahedra");
  }
  name_faces(mesh, grid, made);
  made.mesh = extract_mesh(grid);
  for (const auto &name : mesh.unusable)
    made.unusable.push_back({name.name, name.reason});
  made.notes = std::move(mesh.notes);
  made.notes.back() += "; faces: " + names_of_faces(made);
  made.warnings = std::move(mesh.warnings);
  return made;
}

MeshQuality measure_quality(const HexMesh &mesh)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  MeshQuality quality;
  for (const auto &cell : mesh.cells)
  {
    CellCorners x;
    for (int a = 0; a < 8; ++a)
    {
      const auto &p = mesh.nodes[cell[a]];
      x[a] = vec(p[0], p[1], p[2]);
    }
    const CornerShape corner = worst_corner(x);
    if (corner.scaled_jacobian < quality.scaled_jacobian)
    {
      quality.scaled_jacobian = corner.scaled_jacobian;
      const Vec at = x[corner.number];
      quality.worst = {{at[0], at[1], at[2]}};
    }
    const double shortest = shortest_edge(x);
    quality.aspect_ratio =
        std::max(quality.aspect_ratio,
                 shortest > 0. ? longest_edge(x) / shortest : infinite);
    quality.is_inverted =
        quality.is_inverted || !(least_inner_jacobian(x) > 0.);
  }
  return quality;
}

std::string MeshQuality::text() const
{
  char line[160];
  std::snprintf(line, sizeof(line),
                "least scaled Jacobian %.3g at (%.4g, %.4g, %.4g) m, largest "
                "aspect ratio %.3g",
                scaled_jacobian, worst[0], worst[1], worst[2], aspect_ratio);
  return line;
}
} // namespace sabot
