// Boxes of hexahedra, uniform or graded away from a zone.
#include "sabot/geometry/mesh_generator.h"

#include "sabot/base/error.h"
#include "sabot/base/text.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/geometry/particle_cloud.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/** 0 to 5 for -x, +x, ..., +z where @p x is the center of a face of the box, 6
    where it is one of the zone. */
unsigned int box_face_id(const BoxSpecification &box, const dealii::Point<3> &x)
{
  unsigned int id = 6;
  for (unsigned int d = 0; d < 3; ++d)
  {
    const double low = box.center[d] - 0.5 * box.size[d],
                 high = box.center[d] + 0.5 * box.size[d];
    if (std::abs(x[d] - low) < 1e-9 * box.size[d])
      id = 2 * d;
    if (std::abs(x[d] - high) < 1e-9 * box.size[d])
      id = 2 * d + 1;
  }
  return id;
}
} // namespace

HexMesh make_graded_box(const BoxSpecification &box)
{
  const Planes planes = planes_of(box);
  // Steps, and which cells stay: deal.II leaves out cells of this material id.
  std::vector<std::vector<double>> steps(3);
  dealii::Point<3> low;
  for (unsigned int d = 0; d < 3; ++d)
  {
    low[d] = box.center[d] - 0.5 * box.size[d];
    for (std::size_t i = 1; i < planes[d].size(); ++i)
      steps[d].push_back(planes[d][i] - planes[d][i - 1]);
  }
  dealii::Table<3, dealii::types::material_id> ids(
      steps[0].size(), steps[1].size(), steps[2].size());
  std::size_t n_left = 0;
  for (std::size_t i = 0; i < steps[0].size(); ++i)
    for (std::size_t j = 0; j < steps[1].size(); ++j)
      for (std::size_t k = 0; k < steps[2].size(); ++k)
      {
        const bool cut = is_cut(box, planes, {{i, j, k}});
        ids[i][j][k] = cut ? dealii::numbers::invalid_material_id : 0;
        n_left += !cut;
      }
  if (n_left == 0)
    throw InputError(box.zone_path + "/Size",
                     "the zone leaves nothing of the body that it is carved "
                     "from; make it smaller");
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, steps, low, ids,
                                                    false);
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
      face->set_boundary_id(box_face_id(box, face->center()));
  return extract_mesh(mesh);
}
} // namespace sabot
