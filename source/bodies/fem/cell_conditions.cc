// Shapes, steps and surroundings of hexahedra, for criteria of conversion.
#include "sabot/bodies/fem/cell_conditions.h"

#include "sabot/geometry/cell_shape.h"

namespace sabot
{
namespace
{
CellCorners corners_of(const AlignedVector<Vec> &x,
                       const std::array<std::uint32_t, 8> &nodes)
{
  CellCorners corners;
  for (int a = 0; a < 8; ++a)
    corners[a] = x[nodes[a]];
  return corners;
}

double edge_ratio(const CellCorners &x)
{
  const double least = shortest_edge(x);
  return least > 0. ? longest_edge(x) / least : 1e300;
}
} // namespace

std::vector<std::array<double, 3>> FemCellConditions::centers() const
{
  std::vector<std::array<double, 3>> all(cells.size());
  for (std::size_t e = 0; e < all.size(); ++e)
  {
    const Vec X =
        middle(corners_of(nodes.reference_position, cells.connectivity[e]));
    all[e] = {{X[0], X[1], X[2]}};
  }
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
  std::vector<double> least(cells.size());
  for (std::size_t e = 0; e < least.size(); ++e)
    least[e] = worst_corner(corners_of(nodes.position, cells.connectivity[e]))
                   .scaled_jacobian;
  return least;
}

std::vector<double> FemCellConditions::stretch_of_aspect() const
{
  std::vector<double> ratio(cells.size());
  for (std::size_t e = 0; e < ratio.size(); ++e)
    ratio[e] =
        edge_ratio(corners_of(nodes.position, cells.connectivity[e])) /
        edge_ratio(corners_of(nodes.reference_position, cells.connectivity[e]));
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
