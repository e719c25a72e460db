// The part of a file's mesh that a body takes, and nodes that become one.
#include "sabot/geometry/mesh_check.h"
#include "sabot/geometry/near_points.h"

#include "sabot/base/text.h"

#include <algorithm>
#include <limits>

namespace sabot
{
namespace
{
constexpr FileIndex unused = std::numeric_limits<FileIndex>::max();

std::string names_of_parts(const FileMesh &mesh)
{
  std::vector<std::string> all;
  for (const auto &set : mesh.cell_sets)
    all.push_back(set.name + (set.also.empty() ? "" : " (" + set.also + ")"));
  constexpr std::size_t most = 20;
  if (all.size() > most)
    all.resize(most);
  return all.empty() ? "the file has none" : "the file has " + join(all, ", ");
}

/** By vertices that are left; sets of faces keep only whole ones. */
void renumber_vertices(FileMesh &mesh, const std::vector<FileIndex> &number)
{
  for (auto &cell : mesh.cells)
    for (FileIndex &a : cell)
      a = number[a];
  for (auto &set : mesh.face_sets)
  {
    std::vector<FileFace> kept;
    for (FileFace face : set.faces)
    {
      bool whole = true;
      for (FileIndex &a : face)
      {
        a = number[a];
        whole = whole && a != unused;
      }
      if (whole)
        kept.push_back(face);
    }
    set.faces = std::move(kept);
  }
  for (auto &set : mesh.node_sets)
  {
    std::vector<FileIndex> kept;
    for (const FileIndex a : set.nodes)
      if (number[a] != unused)
        kept.push_back(number[a]);
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    set.nodes = std::move(kept);
  }
}

/** Drops vertices of no cell. */
void drop_unused(FileMesh &mesh)
{
  std::vector<FileIndex> number(mesh.vertices.size(), unused);
  for (const auto &cell : mesh.cells)
    for (const FileIndex a : cell)
      number[a] = 0;
  std::vector<std::array<double, 3>> kept;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != unused)
    {
      number[i] = kept.size();
      kept.push_back(mesh.vertices[i]);
    }
  mesh.vertices = std::move(kept);
  renumber_vertices(mesh, number);
}

void keep_cells(FileMesh &mesh, const std::vector<FileIndex> &cells)
{
  FileMesh part;
  std::vector<FileIndex> number(mesh.cells.size(), unused);
  for (const FileIndex c : cells)
  {
    number[c] = part.cells.size();
    part.add_cell(mesh.cells[c], mesh.label[c], mesh.prefix[c]);
  }
  mesh.cells = std::move(part.cells);
  mesh.label = std::move(part.label);
  mesh.prefix = std::move(part.prefix);
  for (auto &set : mesh.cell_sets)
  {
    std::vector<FileIndex> kept;
    for (const FileIndex c : set.cells)
      if (number[c] != unused)
        kept.push_back(number[c]);
    set.cells = std::move(kept);
  }
}

/** Whether a set has this name: as it is spelled, or else as Abaqus has it. */
bool is_called(const FileMesh::CellSet &set, const std::string &name,
               const bool by_case)
{
  return by_case ? set.name == name || set.also == name
                 : lower_case(set.name) == lower_case(name);
}

/** The set called @p name; 0 is also the cells that are in none. */
std::vector<FileIndex> find_part(const FileMesh &mesh, const MeshWish &wish,
                                 std::size_t &n_others)
{
  std::vector<FileIndex> cells;
  std::vector<char> is_named(mesh.cells.size(), 0);
  std::size_t n_named_others = 0;
  bool found = false;
  const bool by_case = std::any_of(mesh.cell_sets.begin(), mesh.cell_sets.end(),
                                   [&](const FileMesh::CellSet &set)
                                   { return is_called(set, wish.part, true); });
  for (const auto &set : mesh.cell_sets)
  {
    for (const FileIndex c : set.cells)
      is_named[c] = 1;
    n_named_others += set.n_others;
    if (!is_called(set, wish.part, by_case))
      continue;
    found = true;
    cells.insert(cells.end(), set.cells.begin(), set.cells.end());
    n_others += set.n_others;
  }
  if (!found && wish.part == "0")
  {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      if (!is_named[c])
        cells.push_back(c);
    n_others = mesh.n_others - std::min(n_named_others, mesh.n_others);
    found = !cells.empty() || n_others > 0;
  }
  if (!found)
    throw InputError(wish.part_path, "no part of the mesh file is called \"" +
                                         wish.part + "\"; " +
                                         names_of_parts(mesh));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}
} // namespace

void keep_part(FileMesh &mesh, const MeshFile &file, const MeshWish &wish)
{
  std::size_t n_others = mesh.n_others;
  if (wish.part != "all" && wish.part != "-1") // once a word for all
  {
    n_others = 0;
    keep_cells(mesh, find_part(mesh, wish, n_others));
  }
  if (n_others > 0)
    file.refuse(
        std::to_string(n_others) + " of its cells are not hexahedra (" +
        mesh.first_other +
        "); mesh the body with linear hexahedra only, or take a part of "
        "the file by \"Mesh material id\"; " +
        names_of_parts(mesh));
  if (mesh.cells.empty())
    file.refuse("it has no cells that are hexahedra");
  drop_unused(mesh);
}

void join_vertices(FileMesh &mesh, const double distance)
{
  const std::vector<std::size_t> first = first_near(mesh.vertices, distance);
  std::vector<FileIndex> number(first.begin(), first.end());
  std::size_t n_joined = 0;
  for (std::size_t i = 0; i < first.size(); ++i)
    n_joined += first[i] != i;
  renumber_vertices(mesh, number);
  drop_unused(mesh);
  mesh.notes.push_back(std::to_string(n_joined) + " nodes joined to others");
}
} // namespace sabot
