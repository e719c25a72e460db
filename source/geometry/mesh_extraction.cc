// From deal.II's triangulation to arrays.
#include "sabot/geometry/mesh_extraction.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <numeric>

namespace sabot
{
namespace
{
/** Numbers 0..n-1 in the order of a Hilbert curve through the points. */
std::vector<std::size_t>
curve_order(const std::vector<dealii::Point<3>> &points)
{
  const auto code =
      dealii::Utilities::inverse_Hilbert_space_filling_curve(points, 20);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](const std::size_t a, const std::size_t b)
            { return code[a] != code[b] ? code[a] < code[b] : a < b; });
  return order;
}

using Cell = dealii::DoFHandler<3>::active_cell_iterator;

/** deal.II's lexicographic corners in VTK's order. */
constexpr unsigned int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/** The number of each node along the curve, by deal.II's number; the nodes go
    to the mesh. */
std::vector<GlobalIndex> number_nodes(const std::vector<dealii::Point<3>> &node,
                                      HexMesh &mesh)
{
  const std::vector<std::size_t> order = curve_order(node);
  std::vector<GlobalIndex> number(node.size());
  for (std::size_t i = 0; i < node.size(); ++i)
  {
    const dealii::Point<3> &p = node[order[i]];
    number[order[i]] = i;
    mesh.nodes.push_back({{p[0], p[1], p[2]}});
  }
  return number;
}

/** Adds a cell with its volume and mean gradients; @p node: of its corners in
    deal.II's order. */
void add_cell(const dealii::FEValues<3> &values,
              const std::array<GlobalIndex, 8> &node, HexMesh &mesh)
{
  const unsigned int n_points = values.n_quadrature_points;
  std::array<GlobalIndex, 8> nodes;
  std::array<std::array<double, 3>, 8> gradient{};
  double volume = 0.;
  for (unsigned int q = 0; q < n_points; ++q)
    volume += values.JxW(q);
  for (unsigned int a = 0; a < 8; ++a)
  {
    nodes[a] = node[corner[a]];
    for (unsigned int d = 0; d < 3; ++d)
    {
      for (unsigned int q = 0; q < n_points; ++q)
        gradient[a][d] += values.shape_grad(corner[a], q)[d] * values.JxW(q);
      gradient[a][d] /= volume;
    }
  }
  mesh.cells.push_back(nodes);
  mesh.mean_gradient.push_back(gradient);
  mesh.volume.push_back(volume);
}

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
  const dealii::FE_Q<3> fe(1);
  dealii::DoFHandler<3> dofs(mesh);
  dofs.distribute_dofs(fe);
  const dealii::QGauss<3> quadrature(2);
  dealii::FEValues<3> values(
      fe, quadrature, dealii::update_gradients | dealii::update_JxW_values);

  std::vector<dealii::Point<3>> node(dofs.n_dofs()), center;
  std::vector<dealii::types::global_dof_index> local(8);
  std::vector<Cell> cells;
  for (const auto &cell : dofs.active_cell_iterators())
  {
    cell->get_dof_indices(local);
    for (unsigned int a = 0; a < 8; ++a)
      node[local[a]] = cell->vertex(a);
    center.push_back(cell->center());
    cells.push_back(cell);
  }
  HexMesh result;
  const std::vector<GlobalIndex> node_number = number_nodes(node, result);
  for (const std::size_t c : curve_order(center))
  {
    const Cell &cell = cells[c];
    cell->get_dof_indices(local);
    values.reinit(cell);
    std::array<GlobalIndex, 8> nodes;
    for (unsigned int a = 0; a < 8; ++a)
      nodes[a] = node_number[local[a]];
    add_cell(values, nodes, result);
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        add_face(cell, f, nodes, result);
  }
  return result;
}
} // namespace sabot
