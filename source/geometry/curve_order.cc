// Numbers of nodes and cells along a space-filling curve.
#include "sabot/geometry/curve_order.h"

#include <deal.II/base/point.h>
#include <deal.II/base/utilities.h>

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

/** Place of each in @p order. */
std::vector<GlobalIndex> places_in(const std::vector<std::size_t> &order)
{
  std::vector<GlobalIndex> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i;
  return place;
}

std::vector<std::size_t> order_of_nodes(const HexMesh &mesh)
{
  std::vector<dealii::Point<3>> points;
  points.reserve(mesh.nodes.size());
  for (const auto &p : mesh.nodes)
    points.emplace_back(p[0], p[1], p[2]);
  return curve_order(points);
}

std::vector<std::size_t> order_of_cells(const HexMesh &mesh)
{
  std::vector<dealii::Point<3>> centers;
  centers.reserve(mesh.cells.size());
  for (const auto &cell : mesh.cells)
  {
    dealii::Point<3> center;
    for (const GlobalIndex node : cell)
      for (int d = 0; d < 3; ++d)
        center[d] += 0.125 * mesh.nodes[node][d];
    centers.push_back(center);
  }
  return curve_order(centers);
}
} // namespace

HexMesh sorted_along_curve(HexMesh mesh, std::vector<GlobalIndex> face_cell)
{
  HexMesh result;
  const std::vector<std::size_t> cells = order_of_cells(mesh);
  {
    const std::vector<std::size_t> nodes = order_of_nodes(mesh);
    result.nodes.reserve(nodes.size());
    for (const std::size_t i : nodes)
      result.nodes.push_back(mesh.nodes[i]);
    const std::vector<GlobalIndex> place = places_in(nodes);
    for (auto &cell : mesh.cells)
      for (GlobalIndex &node : cell)
        node = place[node];
    for (auto &face : mesh.boundary_faces)
      for (GlobalIndex &node : face)
        node = place[node];
    mesh.nodes = {};
  }
  result.cells.reserve(cells.size());
  result.volume.reserve(cells.size());
  for (const std::size_t c : cells)
  {
    result.cells.push_back(mesh.cells[c]);
    result.volume.push_back(
        mean_gradients(result, result.cells.size() - 1).volume);
  }
  const std::vector<GlobalIndex> place = places_in(cells);
  std::vector<std::size_t> faces(face_cell.size());
  std::iota(faces.begin(), faces.end(), 0);
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const std::size_t a, const std::size_t b)
                   { return place[face_cell[a]] < place[face_cell[b]]; });
  for (const std::size_t f : faces)
  {
    result.boundary_faces.push_back(mesh.boundary_faces[f]);
    result.boundary_id.push_back(mesh.boundary_id[f]);
  }
  return result;
}
} // namespace sabot
