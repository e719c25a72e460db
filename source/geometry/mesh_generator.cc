// Boxes of hexahedra, uniform or graded away from a zone.
#include "sabot/geometry/mesh_generator.h"

#include "sabot/base/error.h"
#include "sabot/base/text.h"
#include "sabot/geometry/curve_order.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/particle_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sabot
{

std::vector<double> growing_sizes(const double length, const double fine,
                                  const double coarsest, const double growth)
{
  std::vector<double> sizes;
  double sum = 0., next = fine;
  while (sum < length * (1. - 1e-9))
  {
    next = std::min(next * growth, std::max(coarsest, fine));
    sizes.push_back(next);
    sum += next;
  }
  // Drop the last when the rest of the room is less than half of it.
  if (sizes.size() > 1 && sum - length > 0.5 * sizes.back())
  {
    sum -= sizes.back();
    sizes.pop_back();
  }
  for (double &size : sizes)
    size *= length / sum;
  return sizes;
}

std::vector<double> graded_planes(const double low, const double high,
                                  const double inner_low,
                                  const double inner_high, const double fine,
                                  const double coarsest, const double growth)
{
  std::vector<double> planes;
  const double tolerance = 1e-9 * (high - low);
  if (inner_low - low > tolerance)
  {
    const auto sizes = growing_sizes(inner_low - low, fine, coarsest, growth);
    double x = inner_low;
    for (const double size : sizes)
      planes.push_back(x -= size);
    planes.back() = low;
    std::reverse(planes.begin(), planes.end());
  }
  const unsigned int n = n_intervals(inner_high - inner_low, fine);
  for (unsigned int i = 0; i <= n; ++i)
    planes.push_back(inner_low + (inner_high - inner_low) * i / n);
  if (high - inner_high > tolerance)
  {
    double x = inner_high;
    for (const double size :
         growing_sizes(high - inner_high, fine, coarsest, growth))
      planes.push_back(x += size);
    planes.back() = high;
  }
  return planes;
}

namespace
{
using Planes = std::array<std::vector<double>, 3>;

/** Where a box begins and ends along an axis, and its fine part. */
struct Range
{
  double low, high, inner_low, inner_high; // [m]
};

/** Along the three axes. Throws InputError where the zone is not inside the
    box. */
std::array<Range, 3> ranges_of(const BoxSpecification &box)
{
  std::array<Range, 3> ranges;
  for (unsigned int d = 0; d < 3; ++d)
  {
    const double low = box.center[d] - 0.5 * box.size[d],
                 high = box.center[d] + 0.5 * box.size[d];
    double inner_low = low, inner_high = high;
    if (box.has_zone)
    {
      inner_low = box.zone_center[d] - 0.5 * box.zone_size[d];
      inner_high = box.zone_center[d] + 0.5 * box.zone_size[d];
      const double tolerance = 1e-6 * box.size[d];
      if (!(inner_low > low - tolerance && inner_high < high + tolerance))
        throw InputError(box.zone_path + "/Size",
                         "the zone reaches outside the body that it is "
                         "part of: along " +
                             std::string(1, "xyz"[d]) +
                             formatted(" from %.6g", 1e3 * inner_low) +
                             formatted(" to %.6g mm", 1e3 * inner_high) +
                             formatted(", the body from %.6g", 1e3 * low) +
                             formatted(" to %.6g mm", 1e3 * high) +
                             "; make it smaller or move its center");
    }
    ranges[d] = {low, high, std::max(inner_low, low),
                 std::min(inner_high, high)};
  }
  return ranges;
}

/** Grid planes of a box along the three axes, fine over the zone. Throws
    InputError where the zone is not inside the box, TooManyItems. */
Planes planes_of(const BoxSpecification &box)
{
  const std::array<Range, 3> ranges = ranges_of(box);
  std::array<double, 3> n;
  for (unsigned int d = 0; d < 3; ++d)
  {
    const Range &r = ranges[d];
    const auto n_growing = [&](const double length)
    {
      return count_of_growing(length > 1e-9 * (r.high - r.low) ? length : 0.,
                              box.cell_size, box.coarsest_cell_size,
                              box.growth_ratio);
    };
    n[d] = n_growing(r.inner_low - r.low) +
           count_of_intervals(r.inner_high - r.inner_low, box.cell_size) +
           n_growing(r.high - r.inner_high);
  }
  check_memory_for(n, Item::cell);
  Planes planes;
  for (unsigned int d = 0; d < 3; ++d)
    planes[d] =
        graded_planes(ranges[d].low, ranges[d].high, ranges[d].inner_low,
                      ranges[d].inner_high, box.cell_size,
                      box.coarsest_cell_size, box.growth_ratio);
  return planes;
}

/** Whether the cell number @p at along the axes gives way to the zone. */
bool is_cut(const BoxSpecification &box, const Planes &planes,
            const std::array<std::size_t, 3> &at)
{
  bool inside = box.has_zone && box.zone_is_cut;
  for (unsigned int d = 0; d < 3; ++d)
  {
    const double middle = 0.5 * (planes[d][at[d]] + planes[d][at[d] + 1]);
    inside = inside &&
             std::abs(middle - box.zone_center[d]) < 0.5 * box.zone_size[d];
  }
  return inside;
}

/** Corners of a cell in VTK order, and of its faces with outward normals: -x,
    +x, ..., +z. */
constexpr int cell_corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
constexpr int face_corner[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                   {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

/** A box on its way to a mesh, cell by cell. */
class BoxOfCells
{
public:
  BoxOfCells(const BoxSpecification &box, const Planes &planes)
      : box(box), planes(planes)
  {
    std::size_t n_nodes = 1;
    for (int d = 0; d < 3; ++d)
    {
      n[d] = planes[d].size() - 1;
      n_nodes *= planes[d].size();
    }
    number.assign(n_nodes, -1);
  }
  HexMesh mesh()
  {
    std::size_t n_cells = 1;
    for (const std::size_t along : n)
      n_cells *= along;
    result.nodes.reserve(number.size());
    result.cells.reserve(n_cells);
    for (std::size_t k = 0; k < n[2]; ++k)
      for (std::size_t j = 0; j < n[1]; ++j)
        for (std::size_t i = 0; i < n[0]; ++i)
          if (!is_cut(box, planes, {{i, j, k}}))
            add_cell({{i, j, k}});
    if (result.cells.empty())
      throw InputError(box.zone_path + "/Size",
                       "the zone leaves nothing of the body that it is carved "
                       "from; make it smaller");
    return sorted_along_curve(std::move(result), std::move(face_cell));
  }

private:
  using Place = std::array<std::size_t, 3>;
  GlobalIndex node_at(const Place &at)
  {
    GlobalIndex &known =
        number[at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2])];
    if (known < 0)
    {
      known = result.nodes.size();
      result.nodes.push_back(
          {{planes[0][at[0]], planes[1][at[1]], planes[2][at[2]]}});
    }
    return known;
  }
  /** 0 to 5 for a face of the box, 6 for one of the zone, -1 between cells. */
  int face_id(const Place &at, const int face) const
  {
    const int d = face / 2;
    if (at[d] == (face % 2 ? n[d] - 1 : 0))
      return face;
    Place across = at;
    across[d] += face % 2 ? 1 : -1;
    return is_cut(box, planes, across) ? 6 : -1;
  }
  void add_cell(const Place &at)
  {
    std::array<GlobalIndex, 8> nodes;
    for (int a = 0; a < 8; ++a)
      nodes[a] = node_at({{at[0] + cell_corner[a][0], at[1] + cell_corner[a][1],
                           at[2] + cell_corner[a][2]}});
    for (int f = 0; f < 6; ++f)
    {
      const int id = face_id(at, f);
      if (id < 0)
        continue;
      std::array<GlobalIndex, 4> face;
      for (int a = 0; a < 4; ++a)
        face[a] = nodes[face_corner[f][a]];
      result.boundary_faces.push_back(face);
      result.boundary_id.push_back(id);
      face_cell.push_back(result.cells.size());
    }
    result.cells.push_back(nodes);
  }

  const BoxSpecification &box;
  const Planes &planes;
  std::array<std::size_t, 3> n;    // cells along the axes
  std::vector<GlobalIndex> number; // of the nodes of all planes, or -1
  std::vector<GlobalIndex> face_cell;
  HexMesh result;
};
} // namespace

// Written down at once: deal.II's triangulation, which other shapes need, takes
// 900 bytes a cell.
HexMesh make_graded_box(const BoxSpecification &box)
{
  const Planes planes = planes_of(box);
  return BoxOfCells(box, planes).mesh();
}
} // namespace sabot
