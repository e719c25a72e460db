// The true shapes of bodies before the run: bounds, roundness, making.
#include "sabot/geometry/outline.h"

#include "sabot/geometry/particle_cloud.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
Vec area_of(const Outline &outline, const std::array<std::size_t, 4> &face)
{
  const auto &x = outline.points;
  return 0.5 * cross(x[face[2]] - x[face[0]], x[face[3]] - x[face[1]]);
}
} // namespace

void Outline::find_bounds()
{
  if (points.empty())
    return;
  low = high = points[0];
  for (const Vec x : points)
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
}

double Outline::spacing() const
{
  double area = 0.;
  for (const auto &face : faces)
    area += norm(area_of(*this, face));
  return faces.empty() ? 0. : std::sqrt(area / faces.size());
}

double Outline::chord_error() const
{
  struct Edge
  {
    std::size_t low, high, face;
  };
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int a = 0; a < 4; ++a)
    {
      const std::size_t p = faces[f][a], q = faces[f][(a + 1) % 4];
      edges.push_back({std::min(p, q), std::max(p, q), f});
    }
  const auto same = [](const Edge &a, const Edge &b)
  { return a.low == b.low && a.high == b.high; };
  std::sort(edges.begin(), edges.end(),
            [](const Edge &a, const Edge &b)
            {
              return a.low != b.low     ? a.low < b.low
                     : a.high != b.high ? a.high < b.high
                                        : a.face < b.face;
            });
  double largest = 0.;
  for (std::size_t e = 1; e < edges.size(); ++e)
  {
    if (!same(edges[e - 1], edges[e]))
      continue;
    const Vec one = area_of(*this, faces[edges[e - 1].face]),
              other = area_of(*this, faces[edges[e].face]);
    const double angle =
        std::atan2(norm(cross(one, other)), dot(one, other)); // of normals
    if (angle > M_PI / 3.)
      continue;
    const double size = std::sqrt(std::max(norm(one), norm(other)));
    largest = std::max(largest, 0.25 * size * angle);
  }
  return largest;
}

Outline outline_of(const HexMesh &mesh, const std::vector<unsigned int> &cut)
{
  Outline outline;
  outline.points.reserve(mesh.nodes.size() + mesh.cells.size());
  for (const auto &p : mesh.nodes)
    outline.points.push_back(vec(p[0], p[1], p[2]));
  // Few and large cells may cross others without a center in them.
  constexpr std::size_t few = 20000;
  const bool is_coarse = mesh.cells.size() < few;
  for (const auto &cell : mesh.cells)
  {
    Vec center = {};
    for (const GlobalIndex a : cell)
      center += 0.125 * outline.points[a];
    outline.points.push_back(center);
    for (int a = 0; is_coarse && a < 8; ++a)
      outline.points.push_back(0.5 * (center + outline.points[cell[a]]));
  }
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const auto &face = mesh.boundary_faces[f];
    outline.faces.push_back({{std::size_t(face[0]), std::size_t(face[1]),
                              std::size_t(face[2]), std::size_t(face[3])}});
    outline.is_cut.push_back(
        std::find(cut.begin(), cut.end(), mesh.boundary_id[f]) != cut.end());
  }
  outline.find_bounds();
  return outline;
}

Outline outline_of(const ParticleCloud &cloud, const std::uint32_t cut)
{
  Outline outline;
  for (const auto &p : cloud.position)
    outline.points.push_back(vec(p[0], p[1], p[2]));
  outline.faces = cloud.skin;
  for (const unsigned int id : cloud.skin_id)
    outline.is_cut.push_back(id < ParticleCloud::n_faces && cut >> id & 1);
  outline.find_bounds();
  return outline;
}
} // namespace sabot
