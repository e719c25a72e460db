// Meshes of problems that no shape of scenes offers: the one place of the
// verification that knows deal.II's grids.
#include "verification/meshes.h"

#include "sabot/geometry/mesh_extraction.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <set>

namespace sabot
{
namespace
{
using Grid = dealii::Triangulation<3>;

void fill(const Block &block, Grid &grid)
{
  dealii::GridGenerator::subdivided_hyper_rectangle(
      grid,
      std::vector<unsigned int>(block.n_cells.begin(), block.n_cells.end()),
      dealii::Point<3>(block.low[0], block.low[1], block.low[2]),
      dealii::Point<3>(block.high[0], block.high[1], block.high[2]));
}

HexMesh moved(Grid &grid,
              const std::function<MeshPoint(const MeshPoint &)> &map)
{
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &x)
      {
        const MeshPoint p = map({{x[0], x[1], x[2]}});
        return dealii::Point<3>(p[0], p[1], p[2]);
      },
      grid);
  return extract_mesh(grid);
}
} // namespace

HexMesh mapped_block(const Block &block,
                     const std::function<MeshPoint(const MeshPoint &)> &map)
{
  Grid grid;
  fill(block, grid);
  return moved(grid, map);
}

HexMesh mapped_cube(const unsigned int n, const double low, const double high,
                    const std::function<MeshPoint(const MeshPoint &)> &map)
{
  Grid grid;
  dealii::GridGenerator::subdivided_hyper_cube(grid, n, low, high);
  return moved(grid, map);
}

HexMesh
hollow_block(const Block &block,
             const std::function<bool(const MeshPoint &center)> &is_empty)
{
  Grid whole, grid;
  fill(block, whole);
  std::set<Grid::active_cell_iterator> empty;
  for (const auto &cell : whole.active_cell_iterators())
  {
    const auto x = cell->center();
    if (is_empty({{x[0], x[1], x[2]}}))
      empty.insert(cell);
  }
  dealii::GridGenerator::create_triangulation_with_removed_cells(whole, empty,
                                                                 grid);
  return extract_mesh(grid);
}

HexMesh loose_cells(const std::vector<std::array<MeshPoint, 8>> &corners)
{
  std::vector<dealii::Point<3>> points;
  std::vector<dealii::CellData<3>> cells;
  for (const auto &of_cell : corners)
  {
    dealii::CellData<3> cell;
    for (int a = 0; a < 8; ++a)
    {
      cell.vertices[a] = points.size();
      points.emplace_back(of_cell[a][0], of_cell[a][1], of_cell[a][2]);
    }
    cells.push_back(cell);
  }
  Grid grid;
  grid.create_triangulation(points, cells, dealii::SubCellData());
  return extract_mesh(grid);
}
} // namespace sabot
