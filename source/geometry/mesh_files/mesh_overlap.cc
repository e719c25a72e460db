// Cells of one piece of a mesh inside of those of another.
#include "sabot/geometry/cell_shape.h"
#include "sabot/geometry/mesh_check.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Whether @p p lies in the cell, deeper than faceted round surfaces do that
    touch each other: by the planes through the middles of its faces. */
bool is_deep_inside(const Vec &p, const CellCorners &x)
{
  constexpr double fraction = 0.1;
  const double depth = fraction * shortest_edge(x);
  for (const auto &f : face_corners)
  {
    const Vec middle = 0.25 * (x[f[0]] + x[f[1]] + x[f[2]] + x[f[3]]),
              normal = cross(x[f[2]] - x[f[0]], x[f[3]] - x[f[1]]);
    if (!(dot(p - middle, normal) < -depth * norm(normal)))
      return false;
  }
  return true;
}

/** Points in buckets, about as many of these as points. */
class Buckets
{
public:
  explicit Buckets(const std::vector<Vec> &points) : low(points[0])
  {
    Vec high = points[0];
    for (const Vec &p : points)
      for (int d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], p[d]);
        high[d] = std::max(high[d], p[d]);
      }
    const double most = std::max(1., std::cbrt(double(points.size())));
    for (int d = 0; d < 3; ++d)
    {
      n[d] = std::size_t(most) + 1;
      size[d] = (high[d] - low[d]) / n[d];
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      sorted.emplace_back(key(place(points[i])), i);
    std::sort(sorted.begin(), sorted.end());
  }

  /** Calls @p visit with the points of the buckets that the box meets, until it
      returns true. */
  template <typename Visit>
  bool any_in(const Vec &from, const Vec &to, const Visit &visit) const
  {
    const auto first = place(from), last = place(to);
    for (std::size_t i = first[0]; i <= last[0]; ++i)
      for (std::size_t j = first[1]; j <= last[1]; ++j)
      {
        // Buckets along z follow each other.
        const std::size_t end = key({{i, j, last[2]}});
        auto at = std::lower_bound(
            sorted.begin(), sorted.end(),
            std::make_pair(key({{i, j, first[2]}}), std::size_t(0)));
        for (; at != sorted.end() && at->first <= end; ++at)
          if (visit(at->second))
            return true;
      }
    return false;
  }

private:
  using Place = std::array<std::size_t, 3>;
  Place place(const Vec &p) const
  {
    Place at;
    for (int d = 0; d < 3; ++d)
    {
      const double cells = size[d] > 0. ? (p[d] - low[d]) / size[d] : 0.;
      at[d] = std::size_t(std::clamp(cells, 0., double(n[d] - 1)));
    }
    return at;
  }
  std::size_t key(const Place &at) const
  {
    return (at[0] * n[1] + at[1]) * n[2] + at[2];
  }

  Vec low, size = {};
  Place n;
  std::vector<std::pair<std::size_t, std::size_t>> sorted; // bucket, point
};
} // namespace

std::optional<std::pair<FileIndex, FileIndex>>
overlapping_cells(const FileMesh &mesh, const std::vector<std::size_t> &piece)
{
  // The middles of cells, and points near their corners.
  std::vector<Vec> points;
  std::vector<FileIndex> cell_of;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const CellCorners x = corners_of(mesh, c);
    const Vec center = middle(x);
    points.push_back(center);
    for (const Vec &corner : x)
      points.push_back(0.25 * center + 0.75 * corner);
    cell_of.insert(cell_of.end(), 9, c);
  }
  const Buckets buckets(points);
  std::pair<FileIndex, FileIndex> found;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const CellCorners x = corners_of(mesh, c);
    Vec low = x[0], high = x[0];
    for (const Vec &corner : x)
      for (int d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], corner[d]);
        high[d] = std::max(high[d], corner[d]);
      }
    const auto lies_here = [&](const std::size_t i)
    {
      if (piece[cell_of[i]] == piece[c] || !is_deep_inside(points[i], x))
        return false;
      found = {cell_of[i], FileIndex(c)};
      return true;
    };
    if (buckets.any_in(low, high, lies_here))
      return found;
  }
  return std::nullopt;
}
} // namespace sabot
