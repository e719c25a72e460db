// Layers of cells that are much thinner than the next ones.
#include "sabot/geometry/mesh_layers.h"

#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace sabot
{
namespace
{
// Faces of a cell in VTK order; those of the numbers 2 k and 2 k + 1 look away
// from each other.
constexpr int face_corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                    {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 0, 4, 7}};

/** A face of a cell, found again by its sorted nodes. */
struct Side
{
  std::array<GlobalIndex, 4> nodes;
  std::size_t cell;
  double height; // of the cell across it [m]
};

Vec position(const HexMesh &mesh, const GlobalIndex node)
{
  const auto &p = mesh.nodes[node];
  return vec(p[0], p[1], p[2]);
}

std::vector<Side> sides_of(const HexMesh &mesh)
{
  std::vector<Side> sides;
  sides.reserve(6 * mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    double area[6];
    for (int f = 0; f < 6; ++f)
    {
      Vec x[4];
      Side side;
      for (int a = 0; a < 4; ++a)
      {
        side.nodes[a] = mesh.cells[c][face_corners[f][a]];
        x[a] = position(mesh, side.nodes[a]);
      }
      area[f] = 0.5 * norm(cross(x[2] - x[0], x[3] - x[1]));
      std::sort(side.nodes.begin(), side.nodes.end());
      side.cell = c;
      sides.push_back(side);
    }
    for (int f = 0; f < 6; ++f)
      sides[6 * c + f].height = 2. * mesh.volume[c] / (area[f] + area[f ^ 1]);
  }
  return sides;
}
} // namespace

ThinLayer find_thin_layer(const HexMesh &mesh)
{
  constexpr double largest_ratio = 4.;
  std::vector<Side> sides = sides_of(mesh);
  std::sort(sides.begin(), sides.end(),
            [](const Side &a, const Side &b) {
              return a.nodes != b.nodes ? a.nodes < b.nodes : a.cell < b.cell;
            });
  ThinLayer layer;
  std::vector<char> is_thin(mesh.cells.size(), 0);
  double worst = largest_ratio;
  for (std::size_t s = 1; s < sides.size(); ++s)
  {
    if (sides[s].nodes != sides[s - 1].nodes)
      continue;
    const bool is_first = sides[s - 1].height < sides[s].height;
    const Side &thin = sides[is_first ? s - 1 : s],
               &thick = sides[is_first ? s : s - 1];
    const double ratio = thick.height / thin.height;
    if (!(ratio > largest_ratio))
      continue;
    is_thin[thin.cell] = 1;
    if (!(ratio > worst))
      continue;
    worst = ratio;
    layer.height = thin.height;
    layer.neighbor = thick.height;
    layer.place = {{0., 0., 0.}};
    for (const GlobalIndex a : mesh.cells[thin.cell])
      for (int d = 0; d < 3; ++d)
        layer.place[d] += 0.125 * mesh.nodes[a][d];
  }
  layer.n_cells = std::count(is_thin.begin(), is_thin.end(), 1);
  return layer;
}

std::string ThinLayer::text() const
{
  char line[300];
  std::snprintf(
      line, sizeof(line),
      "%zu cell%s much thinner than the next, the worst %.3g mm "
      "beside %.3g mm at (%.6g, %.6g, %.6g) mm: such a layer shortens "
      "the step; let sizes and zones end where cells do",
      n_cells, n_cells == 1 ? " is" : "s are", 1e3 * height, 1e3 * neighbor,
      1e3 * place[0], 1e3 * place[1], 1e3 * place[2]);
  return line;
}
} // namespace sabot
