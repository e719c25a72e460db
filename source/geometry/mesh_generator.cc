#include "sabot/geometry/mesh_generator.h"

#include "sabot/base/error.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/geometry/particle_cloud.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace sabot
{
namespace
{
/** Sizes from @p fine growing by @p growth to at most @p coarsest, scaled to
    fill @p length. */
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
} // namespace

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

HexMesh make_graded_box(const BoxSpecification &box)
{
  dealii::Point<3> low, high;
  std::vector<std::vector<double>> planes(3);
  bool zone_inside = true;
  for (unsigned int d = 0; d < 3; ++d)
  {
    low[d] = box.centre[d] - 0.5 * box.size[d];
    high[d] = box.centre[d] + 0.5 * box.size[d];
    double inner_low = low[d], inner_high = high[d];
    if (box.has_zone)
    {
      inner_low = box.zone_centre[d] - 0.5 * box.zone_size[d];
      inner_high = box.zone_centre[d] + 0.5 * box.zone_size[d];
      const double tolerance = 1e-6 * box.size[d];
      zone_inside = zone_inside && inner_low > low[d] - tolerance &&
                    inner_high < high[d] + tolerance;
    }
    planes[d] = graded_planes(low[d], high[d], std::max(inner_low, low[d]),
                              std::min(inner_high, high[d]), box.cell_size,
                              box.coarsest_cell_size, box.growth_ratio);
  }
  if (!zone_inside)
    throw InputError(box.zone_path + "/Size",
                     "the zone reaches outside the body that it is "
                     "part of; make it smaller or move its centre");

  // Steps, and which cells stay: deal.II leaves out cells of this material id.
  std::vector<std::vector<double>> steps(3);
  for (unsigned int d = 0; d < 3; ++d)
    for (std::size_t i = 1; i < planes[d].size(); ++i)
      steps[d].push_back(planes[d][i] - planes[d][i - 1]);
  dealii::Triangulation<3> mesh;
  dealii::Table<3, dealii::types::material_id> ids(
      steps[0].size(), steps[1].size(), steps[2].size());
  std::size_t n_left = 0;
  for (std::size_t i = 0; i < steps[0].size(); ++i)
    for (std::size_t j = 0; j < steps[1].size(); ++j)
      for (std::size_t k = 0; k < steps[2].size(); ++k)
      {
        const std::size_t at[3] = {i, j, k};
        bool inside = box.has_zone;
        for (unsigned int d = 0; d < 3; ++d)
        {
          const double middle = 0.5 * (planes[d][at[d]] + planes[d][at[d] + 1]);
          inside = inside && std::abs(middle - box.zone_centre[d]) <
                                 0.5 * box.zone_size[d];
        }
        inside = inside && box.zone_is_cut;
        ids[i][j][k] = inside ? dealii::numbers::invalid_material_id : 0;
        n_left += !inside;
      }
  if (n_left == 0)
    throw InputError(box.zone_path + "/Size",
                     "the zone leaves nothing of the body that it is carved "
                     "from; make it smaller");
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, steps, low, ids,
                                                    false);
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
    {
      unsigned int id = 6;
      for (unsigned int d = 0; d < 3; ++d)
      {
        if (std::abs(face->center()[d] - low[d]) < 1e-9 * box.size[d])
          id = 2 * d;
        if (std::abs(face->center()[d] - high[d]) < 1e-9 * box.size[d])
          id = 2 * d + 1;
      }
      face->set_boundary_id(id);
    }
  return extract_mesh(mesh);
}

HexMesh make_cylinder(const double radius, const double length,
                      const unsigned int axis,
                      const std::array<double, 3> &centre,
                      const double cell_size, const unsigned int n_cuts,
                      const CylinderGrading &grading)
{
  // A core of n x n cells, bulged so that its corners lie at the core radius
  // and its edge middles a little further out than a square's, and rings.
  const double zone = grading.zone_radius / radius;
  const double core = zone > 0.                  ? 0.55 * zone
                      : grading.core_radius > 0. ? grading.core_radius / radius
                                                 : 0.55;
  const unsigned int n =
      2 * std::max(1u, n_intervals(0.4 / 0.55 * core * radius * std::sqrt(2.),
                                   cell_size));
  // Heights of the rings over the thickness of the shell around the core, or
  // around the zone.
  std::vector<double> heights;
  const double shell =
      radius * (zone > 0. ? 1. - zone : 1. - core * 0.5 / 0.55);
  if (grading.growth_ratio > 1.)
    for (const double size :
         growing_sizes(shell, cell_size, grading.coarsest_cell_size,
                       grading.growth_ratio))
      heights.push_back((heights.empty() ? 0. : heights.back()) + size / shell);
  else
  {
    const unsigned int n_rings = n_intervals(shell, cell_size);
    for (unsigned int ring = 1; ring <= n_rings; ++ring)
      heights.push_back(double(ring) / n_rings);
  }
  heights.back() = 1.;
  const double pi = 3.14159265358979323846;
  std::vector<dealii::Point<2>> points;
  std::vector<dealii::CellData<2>> cells;

  const auto core_point = [&](const double s, const double t)
  {
    // [-1,1]^2 to a square with bulged edges.
    const double corner = core / std::sqrt(2.);
    const double x = corner * s * (1. + 0.12 * (1. - t * t)),
                 y = corner * t * (1. + 0.12 * (1. - s * s));
    return dealii::Point<2>(x, y);
  };
  const auto core_index = [&](const unsigned int i, const unsigned int j)
  { return i + (n + 1) * j; };
  for (unsigned int j = 0; j <= n; ++j)
    for (unsigned int i = 0; i <= n; ++i)
      points.push_back(core_point(2. * i / n - 1., 2. * j / n - 1.));
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
    {
      dealii::CellData<2> cell;
      cell.vertices = {core_index(i, j), core_index(i + 1, j),
                       core_index(i, j + 1), core_index(i + 1, j + 1)};
      cells.push_back(cell);
    }
  // Core boundary, counter-clockwise from the lower left corner.
  std::vector<unsigned int> inner;
  for (unsigned int i = 0; i < n; ++i)
    inner.push_back(core_index(i, 0));
  for (unsigned int j = 0; j < n; ++j)
    inner.push_back(core_index(n, j));
  for (unsigned int i = 0; i < n; ++i)
    inner.push_back(core_index(n - i, n));
  for (unsigned int j = 0; j < n; ++j)
    inner.push_back(core_index(0, n - j));
  const unsigned int n_rim = inner.size();
  std::vector<unsigned int> last = inner;
  // Rings between the core and a circle, or beyond the zone's circle.
  struct Ring
  {
    double f, circle;
    bool beyond;
  };
  std::vector<Ring> rings;
  if (zone > 0.)
  {
    const unsigned int n_inner = n_intervals(0.5 * zone * radius, cell_size);
    for (unsigned int ring = 1; ring <= n_inner; ++ring)
      rings.push_back({double(ring) / n_inner, zone, false});
  }
  for (const double f : heights)
    rings.push_back({f, 1., zone > 0.});
  for (const Ring &ring : rings)
  {
    const double f = ring.f;
    std::vector<unsigned int> next(n_rim);
    for (unsigned int a = 0; a < n_rim; ++a)
    {
      const double angle = pi * (-0.75 + 2. * a / n_rim);
      const dealii::Point<2> rim(std::cos(angle), std::sin(angle));
      next[a] = points.size();
      points.push_back(ring.beyond ? rim * (zone * (1. - f) + f)
                                   : points[inner[a]] * (1. - f) +
                                         rim * (ring.circle * f));
    }
    for (unsigned int a = 0; a < n_rim; ++a)
    {
      const unsigned int b = (a + 1) % n_rim;
      dealii::CellData<2> cell;
      cell.vertices = {last[a], last[b], next[a], next[b]};
      // Counter-clockwise seen from above in deal.II's lexicographic order.
      std::swap(cell.vertices[0], cell.vertices[2]);
      std::swap(cell.vertices[1], cell.vertices[3]);
      cells.push_back(cell);
    }
    last = next;
  }
  // Area of a regular polygon of n_rim corners on the unit circle.
  const double area = 0.5 * n_rim * std::sin(2. * pi / n_rim);
  const double scale = radius * std::sqrt(pi / area);
  for (dealii::Point<2> &p : points)
    p *= scale;

  dealii::GridTools::invert_all_negative_measure_cells(points, cells);
  // Both planes of symmetry are lines of the mesh (n is even).
  cells.erase(std::remove_if(cells.begin(), cells.end(),
                             [&](const dealii::CellData<2> &cell)
                             {
                               dealii::Point<2> middle;
                               for (const unsigned int v : cell.vertices)
                                 middle += 0.25 * points[v];
                               return (n_cuts > 0 && middle[0] < 0.) ||
                                      (n_cuts > 1 && middle[1] < 0.);
                             }),
              cells.end());
  if (n_cuts > 0)
  {
    for (dealii::Point<2> &p : points) // lines exactly in the planes
      for (unsigned int d = 0; d < 2; ++d)
        if (std::abs(p[d]) < 1e-12 * radius)
          p[d] = 0.;
    dealii::SubCellData none;
    dealii::GridTools::delete_unused_vertices(points, cells, none);
  }
  dealii::Triangulation<2> disc;
  disc.create_triangulation(points, cells, dealii::SubCellData());
  dealii::Triangulation<3> mesh;
  const unsigned int n_axial = n_intervals(length, cell_size);
  dealii::GridGenerator::extrude_triangulation(disc, n_axial + 1, length, mesh);
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
    {
      const dealii::Point<3> p = face->center();
      face->set_boundary_id(p[2] < 1e-9 * length                           ? 0
                            : p[2] > length * (1. - 1e-9)                  ? 1
                            : n_cuts > 0 && std::abs(p[0]) < 1e-9 * radius ? 3
                            : n_cuts > 1 && std::abs(p[1]) < 1e-9 * radius ? 4
                                                                           : 2);
    }
  // A cyclic permutation of the axes keeps cells right-handed.
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &p)
      {
        const double local[3] = {p[0], p[1], p[2] - 0.5 * length};
        dealii::Point<3> q;
        for (unsigned int d = 0; d < 3; ++d)
          q[(axis + 1 + d) % 3] = local[d] + centre[(axis + 1 + d) % 3];
        return q;
      },
      mesh);
  return extract_mesh(mesh);
}
} // namespace sabot
