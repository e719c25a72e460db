// Hexahedra that are split into lattices: rows of edges, numbers of sites.
#include "sabot/geometry/split_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace sabot
{
namespace
{
/** Corner in VTK order by bits, bit d: at the upper end of direction d. */
constexpr int corner_of[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/** Bits of the lower end of edge @p place along direction @p d. */
constexpr int low_end(const int d, const int place)
{
  return (place & 1) << (d + 1) % 3 | (place >> 1) << (d + 2) % 3;
}

/** Numbers equal keys alike. @return the number of each key, and sorts and
    thins out the keys themselves. */
template <typename Key>
std::vector<std::uint32_t> number_keys(std::vector<Key> &keys)
{
  std::vector<std::uint32_t> order(keys.size()), number(keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](const std::uint32_t a, const std::uint32_t b)
            { return keys[a] < keys[b]; });
  std::vector<Key> found;
  for (const std::uint32_t k : order)
  {
    if (found.empty() || found.back() != keys[k])
      found.push_back(keys[k]);
    number[k] = found.size() - 1;
  }
  keys = std::move(found);
  return number;
}

std::uint32_t root_of(std::vector<std::uint32_t> &parent, std::uint32_t k)
{
  while (parent[k] != k)
    k = parent[k] = parent[parent[k]];
  return k;
}
} // namespace

GlobalIndex SplitMesh::at(const GlobalIndex cell, const int bits) const
{
  return mesh.cells[cell][corner_of[bits]];
}

SplitMesh::SplitMesh(HexMesh whole, const double spacing)
    : mesh(std::move(whole)), cells(mesh.cells.size())
{
  find_edges();
  find_parts(spacing);
  find_faces();
  number_sites();
  find_cells_of_nodes();
}

void SplitMesh::find_edges()
{
  std::vector<std::array<GlobalIndex, 2>> ends;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int d = 0; d < 3; ++d)
      for (int place = 0; place < 4; ++place)
      {
        const int bits = low_end(d, place);
        const GlobalIndex a = at(c, bits), b = at(c, bits | 1 << d);
        ends.push_back({{std::min(a, b), std::max(a, b)}});
      }
  const std::vector<std::uint32_t> number = number_keys(ends);
  for (std::size_t k = 0; k < number.size(); ++k)
    cells[k / 12].edge[k % 12] = number[k];
  for (const auto &pair : ends)
    edges.push_back({pair, 0, 0});
}

void SplitMesh::find_parts(const double spacing)
{
  std::vector<std::uint32_t> row(edges.size());
  std::iota(row.begin(), row.end(), 0);
  for (const Cell &cell : cells)
    for (int e = 0; e < 12; ++e)
    {
      const std::uint32_t a = root_of(row, cell.edge[e]),
                          b = root_of(row, cell.edge[e / 4 * 4]);
      row[std::max(a, b)] = std::min(a, b);
    }
  std::vector<double> length(edges.size(), 0.);
  std::vector<std::uint32_t> n(edges.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += std::pow(
          mesh.nodes[edges[e].node[1]][d] - mesh.nodes[edges[e].node[0]][d], 2);
    edges[e].row = root_of(row, e);
    length[edges[e].row] += std::sqrt(square);
    ++n[edges[e].row];
  }
  ratio = {std::numeric_limits<unsigned int>::max(), 1};
  for (Edge &edge : edges)
  {
    edge.row = n_intervals(length[edge.row] / n[edge.row], spacing);
    ratio.first = std::min(ratio.first, edge.row);
    ratio.second = std::max(ratio.second, edge.row);
  }
  for (Cell &cell : cells)
    for (int d = 0; d < 3; ++d)
      cell.parts[d] = edges[cell.edge[4 * d]].row;
}

void SplitMesh::find_faces()
{
  std::vector<std::array<GlobalIndex, 4>> keys;
  std::vector<std::array<std::uint32_t, 2>> parts;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int f = 0; f < 6; ++f)
    {
      const int d = f / 2, a = (d + 1) % 3, b = (d + 2) % 3, side = f % 2 << d;
      int origin = side;
      for (int k = 1; k < 4; ++k)
      {
        const int bits = side | (k & 1) << a | (k >> 1) << b;
        if (at(c, bits) < at(c, origin))
          origin = bits;
      }
      const bool swaps = at(c, origin ^ 1 << b) < at(c, origin ^ 1 << a);
      const int first = swaps ? b : a, second = swaps ? a : b;
      keys.push_back({{at(c, origin), at(c, origin ^ 1 << first),
                       at(c, origin ^ 1 << second),
                       at(c, origin ^ 1 << first ^ 1 << second)}});
      parts.push_back({{cells[c].parts[first], cells[c].parts[second]}});
    }
  const std::vector<std::uint32_t> number = number_keys(keys);
  for (const auto &key : keys)
    faces.push_back({key, {}, 0});
  for (std::size_t k = 0; k < number.size(); ++k)
  {
    cells[k / 6].face[k % 6] = number[k];
    faces[number[k]].parts = parts[k];
  }
  // Faces of the boundary are those of one cell.
  std::vector<std::uint32_t> user(faces.size());
  for (std::size_t k = 0; k < number.size(); ++k)
    user[number[k]] = k;
  std::vector<std::pair<std::array<GlobalIndex, 4>, std::uint32_t>> sorted;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    sorted.emplace_back(faces[f].node, f);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    std::pair<std::array<GlobalIndex, 4>, std::uint32_t> face{
        mesh.boundary_faces[f], 0};
    std::sort(face.first.begin(), face.first.end());
    const std::uint32_t k =
        user[std::lower_bound(sorted.begin(), sorted.end(), face)->second];
    outside.push_back({k / 6, k % 6, mesh.boundary_id[f], f});
  }
  std::sort(outside.begin(), outside.end(),
            [](const Outside &a, const Outside &b) {
              return std::tie(a.cell, a.number) < std::tie(b.cell, b.number);
            });
}

void SplitMesh::number_sites()
{
  n_all = mesh.nodes.size();
  for (Edge &edge : edges)
  {
    edge.first = n_all;
    n_all += edge.row - 1;
  }
  for (Face &face : faces)
  {
    face.first = n_all;
    n_all += GlobalIndex(face.parts[0] - 1) * (face.parts[1] - 1);
  }
  for (Cell &cell : cells)
  {
    cell.first = n_all;
    n_all += GlobalIndex(cell.parts[0] - 1) * (cell.parts[1] - 1) *
             (cell.parts[2] - 1);
  }
}

void SplitMesh::find_cells_of_nodes()
{
  start_of_node.assign(mesh.nodes.size() + 1, 0);
  for (const auto &corners : mesh.cells)
    for (const GlobalIndex a : corners)
      ++start_of_node[a + 1];
  std::partial_sum(start_of_node.begin(), start_of_node.end(),
                   start_of_node.begin());
  cells_of_node.resize(start_of_node.back());
  std::vector<std::size_t> next(start_of_node.begin(), start_of_node.end() - 1);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const GlobalIndex a : mesh.cells[c])
      cells_of_node[next[a]++] = c;
}

SplitMesh::Carrier SplitMesh::carrier(const GlobalIndex site) const
{
  // The last whose first site is no later; those without sites come before.
  const auto last = [site](const auto &all)
  {
    return std::upper_bound(all.begin(), all.end(), site,
                            [](const GlobalIndex s, const auto &item)
                            { return s < item.first; }) -
           1;
  };
  if (site < n_nodes())
    return {1, {{site}}, {{1.}}};
  if (edges.back().first + edges.back().row - 1 > site)
  {
    const auto edge = last(edges);
    const double t = double(site - edge->first + 1) / edge->row;
    return {2, {{edge->node[0], edge->node[1]}}, {{1. - t, t}}};
  }
  if (cells.front().first > site)
  {
    const auto face = last(faces);
    const GlobalIndex k = site - face->first, n = face->parts[0] - 1;
    const double s = double(k % n + 1) / face->parts[0],
                 t = double(k / n + 1) / face->parts[1];
    Carrier carrier{
        4, {}, {{(1. - s) * (1. - t), s * (1. - t), (1. - s) * t, s * t}}};
    std::copy(face->node.begin(), face->node.end(), carrier.node.begin());
    return carrier;
  }
  const auto cell = last(cells);
  const GlobalIndex k = site - cell->first, n = cell->parts[0] - 1,
                    m = cell->parts[1] - 1;
  const GlobalIndex place[3] = {k % n + 1, k / n % m + 1, k / (n * m) + 1};
  std::array<std::pair<GlobalIndex, double>, 8> all;
  for (int bits = 0; bits < 8; ++bits)
  {
    all[bits] = {at(cell - cells.begin(), bits), 1.};
    for (int d = 0; d < 3; ++d)
    {
      const double t = double(place[d]) / cell->parts[d];
      all[bits].second *= bits >> d & 1 ? t : 1. - t;
    }
  }
  std::sort(all.begin(), all.end());
  Carrier carrier{8, {}, {}};
  for (int a = 0; a < 8; ++a)
    std::tie(carrier.node[a], carrier.weight[a]) = all[a];
  return carrier;
}

std::vector<GlobalIndex> SplitMesh::cells_around(const Carrier &carrier) const
{
  std::vector<GlobalIndex> found;
  const GlobalIndex a = carrier.node[0];
  for (std::size_t k = start_of_node[a]; k < start_of_node[a + 1]; ++k)
  {
    const auto &corners = mesh.cells[cells_of_node[k]];
    if (std::all_of(carrier.node.begin(), carrier.node.begin() + carrier.n,
                    [&](const GlobalIndex node) {
                      return std::find(corners.begin(), corners.end(), node) !=
                             corners.end();
                    }))
      found.push_back(cells_of_node[k]);
  }
  return found;
}

GlobalIndex SplitMesh::site_in_face(const GlobalIndex cell, const int d,
                                    const Index &i) const
{
  const Cell &c = cells[cell];
  const int side = i[d] == 0 ? 0 : 1;
  const Face &face = faces[c.face[2 * d + side]];
  // Directions and sense in which the face counts.
  int origin = 0;
  while (at(cell, origin) != face.node[0])
    ++origin;
  int first = (d + 1) % 3, second = (d + 2) % 3;
  if (at(cell, origin ^ 1 << first) != face.node[1])
    std::swap(first, second);
  const auto steps = [&](const int axis)
  { return origin >> axis & 1 ? c.parts[axis] - i[axis] : i[axis]; };
  return face.first + (steps(first) - 1) +
         GlobalIndex(face.parts[0] - 1) * (steps(second) - 1);
}

GlobalIndex SplitMesh::site_at(const GlobalIndex cell, const Index &i) const
{
  const Cell &c = cells[cell];
  int ends = 0, bits = 0, inner = 0, outer = 0; // directions
  for (int d = 0; d < 3; ++d)
    if (i[d] == 0 || i[d] == c.parts[d])
    {
      ++ends;
      bits |= (i[d] > 0) << d;
      outer = d;
    }
    else
      inner = d;
  if (ends == 3)
    return at(cell, bits);
  if (ends == 1)
    return site_in_face(cell, outer, i);
  if (ends == 0)
    return c.first + (i[0] - 1) +
           GlobalIndex(c.parts[0] - 1) *
               ((i[1] - 1) + GlobalIndex(c.parts[1] - 1) * (i[2] - 1));
  const int place =
      (bits >> (inner + 1) % 3 & 1) | (bits >> (inner + 2) % 3 & 1) << 1;
  const Edge &edge = edges[c.edge[4 * inner + place]];
  const unsigned int step =
      at(cell, bits) == edge.node[0] ? i[inner] : edge.row - i[inner];
  return edge.first + step - 1;
}

std::vector<SplitMesh::Member> SplitMesh::members(const GlobalIndex cell) const
{
  const auto &n = cells[cell].parts;
  std::vector<Member> found;
  Index i;
  for (i[2] = 0; i[2] <= n[2]; ++i[2])
    for (i[1] = 0; i[1] <= n[1]; ++i[1])
      for (i[0] = 0; i[0] <= n[0]; ++i[0])
      {
        Member member{site_at(cell, i), 1., {}};
        for (int d = 0; d < 3; ++d)
        {
          const bool low = i[d] == 0, high = i[d] == n[d];
          member.share *= (low || high ? 0.5 : 1.) / n[d];
          member.middle[d] = (2. * i[d] + (low    ? 0.5
                                           : high ? -0.5
                                                  : 0.)) /
                                 n[d] -
                             1.;
        }
        found.push_back(member);
      }
  return found;
}

std::vector<double> SplitMesh::sites_by_node() const
{
  std::vector<double> n(mesh.nodes.size(), 0.);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const GlobalIndex a : mesh.cells[c])
      n[a] += 0.125 * cells[c].parts[0] * cells[c].parts[1] * cells[c].parts[2];
  return n;
}
} // namespace sabot
