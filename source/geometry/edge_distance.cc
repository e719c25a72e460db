// How far the boundary of a mesh goes on as a plane.
#include "sabot/geometry/edge_distance.h"

#include "sabot/kernels/vec.h"

#include <functional>
#include <limits>
#include <queue>

namespace sabot
{
std::vector<double> edge_distances(const HexMesh &mesh)
{
  constexpr double flat = 1e-10; // 1 - cosine: 1e-5 of angle
  const std::size_t n = mesh.nodes.size();
  const auto at = [&](const GlobalIndex a)
  { return vec(mesh.nodes[a][0], mesh.nodes[a][1], mesh.nodes[a][2]); };
  std::vector<Vec> area(n, Vec{});
  std::vector<double> size(n, 0.);
  std::vector<std::vector<std::size_t>> faces_of(n);
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const auto &face = mesh.boundary_faces[f];
    const Vec its = cross(at(face[2]) - at(face[0]), at(face[3]) - at(face[1]));
    for (const GlobalIndex a : face)
    {
      area[a] += its;
      size[a] += norm(its);
      faces_of[a].push_back(f);
    }
  }
  // From all edges at once, the nearest first.
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>>
      next;
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  for (std::size_t a = 0; a < n; ++a)
    if (!(norm(area[a]) > (1. - flat) * size[a]))
    {
      distance[a] = 0.;
      if (!faces_of[a].empty())
        next.emplace(0., a);
    }
  while (!next.empty())
  {
    const auto [way, a] = next.top();
    next.pop();
    if (way > distance[a])
      continue;
    for (const std::size_t f : faces_of[a])
      for (const GlobalIndex b : mesh.boundary_faces[f])
      {
        const double further = way + norm(at(b) - at(a));
        if (further < distance[b])
        {
          distance[b] = further;
          next.emplace(further, b);
        }
      }
  }
  return distance;
}
} // namespace sabot
