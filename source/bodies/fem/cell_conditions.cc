// Shapes, steps and surroundings of hexahedra, for criteria of conversion.
#include "sabot/bodies/fem/cell_conditions.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Corners joined to each corner, so that the edges to them make a right-handed
    system; VTK order. */
constexpr int joined[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                              {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
constexpr int edges[12][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6},
                              {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

double edge_ratio(const AlignedVector<Vec> &x,
                  const std::array<std::uint32_t, 8> &corner)
{
  double least = 1e300, most = 0.;
  for (const auto &edge : edges)
  {
    const double length = norm(x[corner[edge[1]]] - x[corner[edge[0]]]);
    least = std::min(least, length);
    most = std::max(most, length);
  }
  return least > 0. ? most / least : 1e300;
}
} // namespace

std::vector<std::array<double, 3>> FemCellConditions::centers() const
{
  std::vector<std::array<double, 3>> all(cells.size());
  for (std::size_t e = 0; e < all.size(); ++e)
    for (const std::uint32_t a : cells.connectivity[e])
      for (int d = 0; d < 3; ++d)
        all[e][d] += nodes.reference_position[a][d] / 8.;
  return all;
}

std::vector<double> FemCellConditions::step_ratio()
{
  std::vector<double> ratio(cells.size(), 1.);
  if (!start_steps.empty())
    for (std::size_t e = 0; e < ratio.size(); ++e)
      ratio[e] = cells.cell_step[e] / start_steps[living.initial_number(e)];
  return ratio;
}

std::vector<double> FemCellConditions::scaled_jacobian() const
{
  std::vector<double> least(cells.size(), 1.);
  for (std::size_t e = 0; e < least.size(); ++e)
  {
    const auto &corner = cells.connectivity[e];
    for (int a = 0; a < 8; ++a)
    {
      Vec edge[3];
      double lengths = 1.;
      for (int k = 0; k < 3; ++k)
      {
        edge[k] =
            nodes.position[corner[joined[a][k]]] - nodes.position[corner[a]];
        lengths *= norm(edge[k]);
      }
      const double det = dot(cross(edge[0], edge[1]), edge[2]);
      least[e] = std::min(least[e], lengths > 0. ? det / lengths : 0.);
    }
  }
  return least;
}

std::vector<double> FemCellConditions::stretch_of_aspect() const
{
  std::vector<double> ratio(cells.size());
  for (std::size_t e = 0; e < ratio.size(); ++e)
    ratio[e] = edge_ratio(nodes.position, cells.connectivity[e]) /
               edge_ratio(nodes.reference_position, cells.connectivity[e]);
  return ratio;
}

std::vector<char>
FemCellConditions::near_failure(const unsigned int layers) const
{
  std::vector<char> at_node = is_failed, of_cell(cells.size(), 0);
  for (unsigned int layer = 0; layer < layers; ++layer)
  {
    for (std::size_t e = 0; e < of_cell.size(); ++e)
      for (const std::uint32_t a : cells.connectivity[e])
        of_cell[e] |= at_node[a];
    for (std::size_t e = 0; e < of_cell.size(); ++e)
      if (of_cell[e])
        for (const std::uint32_t a : cells.connectivity[e])
          at_node[a] = 1;
    exchange.update(at_node.data());
  }
  return of_cell;
}
} // namespace sabot
