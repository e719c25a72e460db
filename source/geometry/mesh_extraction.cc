// From deal.II's triangulation to arrays.
#include "sabot/geometry/mesh_extraction.h"

#include "sabot/geometry/curve_order.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/tria.h>

#include <utility>

namespace sabot
{
namespace
{
using Cell = dealii::DoFHandler<3>::active_cell_iterator;

/** deal.II's lexicographic corners in VTK's order. */
constexpr unsigned int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/** Adds face @p f of a cell, its normal turned outwards. */
void add_face(const Cell &cell, const unsigned int f,
              const std::array<GlobalIndex, 8> &node, HexMesh &mesh)
{
  std::array<GlobalIndex, 4> face;
  constexpr unsigned int around[4] = {0, 1, 3, 2};
  dealii::Point<3> x[4];
  for (unsigned int a = 0; a < 4; ++a)
  {
    const unsigned int vertex =
        dealii::GeometryInfo<3>::face_to_cell_vertices(f, around[a]);
    face[a] = node[vertex];
    x[a] = cell->vertex(vertex);
  }
  const dealii::Tensor<1, 3> normal =
      dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]);
  if (normal * (cell->face(f)->center() - cell->center()) < 0.)
    std::swap(face[1], face[3]);
  mesh.boundary_faces.push_back(face);
  mesh.boundary_id.push_back(cell->face(f)->boundary_id());
}
} // namespace

HexMesh extract_mesh(const dealii::Triangulation<3, 3> &mesh)
{
  HexMesh result;
  std::vector<GlobalIndex> face_cell;
  {
    const dealii::FE_Q<3> fe(1);
    dealii::DoFHandler<3> dofs(mesh);
    dofs.distribute_dofs(fe);
    std::vector<dealii::types::global_dof_index> local(8);
    result.nodes.resize(dofs.n_dofs());
    result.cells.reserve(mesh.n_active_cells());
    for (const auto &cell : dofs.active_cell_iterators())
    {
      cell->get_dof_indices(local);
      std::array<GlobalIndex, 8> nodes, ordered;
      for (unsigned int a = 0; a < 8; ++a)
      {
        nodes[a] = local[a];
        for (unsigned int d = 0; d < 3; ++d)
          result.nodes[local[a]][d] = cell->vertex(a)[d];
        ordered[a] = local[corner[a]];
      }
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
        {
          add_face(cell, f, nodes, result);
          face_cell.push_back(result.cells.size());
        }
      result.cells.push_back(ordered);
    }
  }
  return sorted_along_curve(std::move(result), std::move(face_cell));
}
} // namespace sabot
