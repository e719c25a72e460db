// Meshes that other programs have made: reading, and how good they are.
#include "sabot/geometry/mesh_import.h"

#include "sabot/base/error.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/kernels/vec.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

namespace sabot
{
namespace
{
std::string extension(const std::string &file)
{
  const std::size_t slash = file.find_last_of('/'),
                    dot = file.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
    return "";
  std::string end = file.substr(dot + 1);
  for (char &c : end)
    c = std::tolower(c);
  return end;
}

/** First line of what deal.II says. */
std::string reason(const dealii::ExceptionBase &e)
{
  std::ostringstream text;
  e.print_info(text);
  std::string line;
  std::istringstream lines(text.str());
  while (std::getline(lines, line))
  {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string::npos)
      return line.substr(first);
  }
  return "it is not as the format wants it";
}

/** The ending, checked to name a format that can be read. */
std::string format_of(const std::string &file, const std::string &path)
{
  const std::string format = extension(file);
  if (format == "e" || format == "ex2" || format == "exo" || format == "g" ||
      format == "exodus")
    throw InputError(path, "\"" + file +
                               "\" is an Exodus file, and this deal.II was "
                               "built without a reader for it; convert it to "
                               "gmsh (.msh), Abaqus (.inp) or VTK (.vtk)");
  if (format != "msh" && format != "inp" && format != "vtk")
    throw InputError(path, "\"" + file +
                               "\": the ending names no known format; use "
                               ".msh (gmsh), .inp (Abaqus) or .vtk");
  return format;
}

void read_grid(const std::string &file, const std::string &path,
               dealii::Triangulation<3> &grid)
{
  const std::string format = format_of(file, path);
  std::ifstream stream(file);
  if (!stream)
    throw InputError(path, "cannot open the mesh file \"" + file + "\"");
  dealii::GridIn<3> reader(grid);
  try
  {
    if (format == "msh")
      reader.read_msh(stream);
    else if (format == "inp")
      reader.read_abaqus(stream);
    else
      reader.read_vtk(stream);
  }
  catch (const dealii::ExceptionBase &e)
  {
    throw InputError(path, "cannot read the mesh file \"" + file +
                               "\": " + reason(e));
  }
  catch (const std::exception &e)
  {
    throw InputError(path, "cannot read the mesh file \"" + file +
                               "\": it is not as the format wants it");
  }
}
} // namespace

HexMesh read_mesh(const std::string &file, const double unit,
                  const std::array<double, 3> &origin,
                  const std::optional<unsigned int> material_id,
                  const std::string &path)
{
  dealii::Triangulation<3> whole;
  read_grid(file, path, whole);
  std::set<typename dealii::Triangulation<3>::active_cell_iterator> others;
  for (const auto &cell : whole.active_cell_iterators())
  {
    if (!cell->reference_cell().is_hyper_cube())
      throw InputError(path, "\"" + file +
                                 "\" has cells that are not hexahedra; mesh "
                                 "the body with hexahedra only");
    if (material_id && cell->material_id() != *material_id)
      others.insert(cell);
  }
  if (whole.n_active_cells() == others.size())
    throw InputError(path, "\"" + file + "\" has no cells" +
                               (material_id ? " with the material id " +
                                                  std::to_string(*material_id)
                                            : std::string()));
  dealii::Triangulation<3> part;
  if (!others.empty())
    dealii::GridGenerator::create_triangulation_with_removed_cells(
        whole, others, part);
  dealii::Triangulation<3> &mesh = others.empty() ? whole : part;
  dealii::GridTools::scale(unit, mesh);
  dealii::GridTools::shift(
      dealii::Tensor<1, 3>({origin[0], origin[1], origin[2]}), mesh);
  return extract_mesh(mesh);
}

MeshQuality measure_quality(const HexMesh &mesh)
{
  // The neighbors of each corner, right-handed, in VTK order.
  constexpr int next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                              {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  constexpr double infinite = std::numeric_limits<double>::infinity();
  MeshQuality quality;
  for (const auto &cell : mesh.cells)
  {
    const auto corner = [&](const int a)
    {
      const auto &p = mesh.nodes[cell[a]];
      return vec(p[0], p[1], p[2]);
    };
    double shortest = infinite, longest = 0.;
    for (int a = 0; a < 8; ++a)
    {
      Vec edge[3];
      double length[3];
      for (int d = 0; d < 3; ++d)
      {
        edge[d] = corner(next[a][d]) - corner(a);
        length[d] = norm(edge[d]);
        shortest = std::min(shortest, length[d]);
        longest = std::max(longest, length[d]);
      }
      const double product = length[0] * length[1] * length[2];
      const double scaled =
          product > 0. ? dot(edge[0], cross(edge[1], edge[2])) / product : 0.;
      if (scaled < quality.scaled_jacobian)
      {
        quality.scaled_jacobian = scaled;
        const Vec x = corner(a);
        quality.worst = {{x[0], x[1], x[2]}};
      }
    }
    quality.aspect_ratio = std::max(
        quality.aspect_ratio, shortest > 0. ? longest / shortest : infinite);
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
