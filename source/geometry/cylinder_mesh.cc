// Cylinders of hexahedra: an o-grid of quadrilaterals, extruded.
#include "sabot/base/text.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/particle_cloud.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Quadrilaterals that fill a disc: a square core with bulged edges and rings
    around it, first in the unit disc, then scaled to the exact area. */
class Disc
{
public:
  /** Throws TooManyItems where that many of it in @p n_layers would be. */
  Disc(const double radius, const double cell_size,
       const CylinderGrading &grading, const double n_layers)
      : radius(radius), zone(grading.zone_radius.value_or(0.) / radius),
        core(zone > 0.             ? 0.55 * zone
             : grading.core_radius ? *grading.core_radius / radius
                                   : 0.55),
        n(count_core(cell_size, grading, n_layers))
  {
    add_core();
    add_rings(cell_size, grading);
    // Area of a regular polygon of n_rim corners on the unit circle.
    const unsigned int n_rim = 4 * n;
    const double area = 0.5 * n_rim * std::sin(2. * M_PI / n_rim);
    const double scale = radius * std::sqrt(M_PI / area);
    for (dealii::Point<2> &p : points)
      p *= scale;
    dealii::GridTools::invert_all_negative_measure_cells(points, cells);
  }

  /** Keep the half where x is not negative, or the quarter where y is not,
      either. */
  void cut(const unsigned int n_cuts)
  {
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
    if (n_cuts == 0)
      return;
    for (dealii::Point<2> &p : points) // lines exactly in the planes
      for (unsigned int d = 0; d < 2; ++d)
        if (std::abs(p[d]) < 1e-12 * radius)
          p[d] = 0.;
    dealii::SubCellData none;
    dealii::GridTools::delete_unused_vertices(points, cells, none);
  }

  void make(dealii::Triangulation<2> &mesh) const
  {
    mesh.create_triangulation(points, cells, dealii::SubCellData());
  }

private:
  /** Between the core and a circle, or beyond the zone's circle. */
  struct Ring
  {
    double f, circle;
    bool beyond;
  };

  /** Cells across the core, after a look at how many there are in all. */
  unsigned int count_core(const double cell_size,
                          const CylinderGrading &grading,
                          const double n_layers) const
  {
    const double across =
        2. * count_of_intervals(0.4 / 0.55 * core * radius * std::sqrt(2.),
                                cell_size);
    double n_rings =
        zone > 0. ? count_of_intervals(0.5 * zone * radius, cell_size) : 0.;
    n_rings +=
        grading.growth_ratio > 1.
            ? count_of_growing(shell(), cell_size, grading.coarsest_cell_size,
                               grading.growth_ratio)
            : count_of_intervals(shell(), cell_size);
    check_memory_for((across * across + 4. * across * n_rings) * n_layers,
                     Item::cell,
                     formatted("%.6g across the core, ", across) +
                         formatted("%.6g rings, ", n_rings) +
                         formatted("%.6g layers", n_layers));
    return across;
  }

  /** Thickness of what is around the core, or around the zone. */
  double shell() const
  {
    return radius * (zone > 0. ? 1. - zone : 1. - core * 0.5 / 0.55);
  }

  unsigned int core_index(const unsigned int i, const unsigned int j) const
  {
    return i + (n + 1) * j;
  }

  /** n x n cells, bulged so that the corners lie at the core radius and the
      edge middles a little further out than a square's. */
  void add_core()
  {
    // [-1,1]^2 to a square with bulged edges.
    const double corner = core / std::sqrt(2.);
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double s = 2. * i / n - 1., t = 2. * j / n - 1.;
        points.emplace_back(corner * s * (1. + 0.12 * (1. - t * t)),
                            corner * t * (1. + 0.12 * (1. - s * s)));
      }
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        dealii::CellData<2> cell;
        cell.vertices = {core_index(i, j), core_index(i + 1, j),
                         core_index(i, j + 1), core_index(i + 1, j + 1)};
        cells.push_back(cell);
      }
  }

  /** Counter-clockwise from the lower left corner. */
  std::vector<unsigned int> core_boundary() const
  {
    std::vector<unsigned int> inner;
    for (unsigned int i = 0; i < n; ++i)
      inner.push_back(core_index(i, 0));
    for (unsigned int j = 0; j < n; ++j)
      inner.push_back(core_index(n, j));
    for (unsigned int i = 0; i < n; ++i)
      inner.push_back(core_index(n - i, n));
    for (unsigned int j = 0; j < n; ++j)
      inner.push_back(core_index(0, n - j));
    return inner;
  }

  /** Heights of the rings over the thickness of the shell around the core, or
      around the zone. */
  std::vector<double> ring_heights(const double cell_size,
                                   const CylinderGrading &grading) const
  {
    std::vector<double> heights;
    const double shell = this->shell();
    if (grading.growth_ratio > 1.)
      for (const double size :
           growing_sizes(shell, cell_size, grading.coarsest_cell_size,
                         grading.growth_ratio))
        heights.push_back((heights.empty() ? 0. : heights.back()) +
                          size / shell);
    else
    {
      const unsigned int n_rings = n_intervals(shell, cell_size);
      for (unsigned int ring = 1; ring <= n_rings; ++ring)
        heights.push_back(double(ring) / n_rings);
    }
    heights.back() = 1.;
    return heights;
  }

  void add_rings(const double cell_size, const CylinderGrading &grading)
  {
    std::vector<Ring> rings;
    if (zone > 0.)
    {
      const unsigned int n_inner = n_intervals(0.5 * zone * radius, cell_size);
      for (unsigned int ring = 1; ring <= n_inner; ++ring)
        rings.push_back({double(ring) / n_inner, zone, false});
    }
    for (const double f : ring_heights(cell_size, grading))
      rings.push_back({f, 1., zone > 0.});
    const std::vector<unsigned int> inner = core_boundary();
    std::vector<unsigned int> last = inner;
    for (const Ring &ring : rings)
      last = add_ring(ring, inner, last);
  }

  /** @return its outer points. */
  std::vector<unsigned int> add_ring(const Ring &ring,
                                     const std::vector<unsigned int> &inner,
                                     const std::vector<unsigned int> &last)
  {
    const unsigned int n_rim = inner.size();
    const double f = ring.f;
    std::vector<unsigned int> next(n_rim);
    for (unsigned int a = 0; a < n_rim; ++a)
    {
      const double angle = M_PI * (-0.75 + 2. * a / n_rim);
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
    return next;
  }

  const double radius;
  const double zone, core; // radii over that of the disc; zone 0: none
  const unsigned int n;    // cells across the core, even
  std::vector<dealii::Point<2>> points;
  std::vector<dealii::CellData<2>> cells;
};

/** See make_cylinder(); @p p: center of a face, axis along z from 0. */
unsigned int cylinder_face_id(const dealii::Point<3> &p, const double radius,
                              const double length, const unsigned int n_cuts)
{
  return p[2] < 1e-9 * length                           ? 0
         : p[2] > length * (1. - 1e-9)                  ? 1
         : n_cuts > 0 && std::abs(p[0]) < 1e-9 * radius ? 3
         : n_cuts > 1 && std::abs(p[1]) < 1e-9 * radius ? 4
                                                        : 2;
}
} // namespace

HexMesh make_cylinder(const double radius, const double length,
                      const unsigned int axis,
                      const std::array<double, 3> &center,
                      const double cell_size, const unsigned int n_cuts,
                      const CylinderGrading &grading)
{
  Disc disc(radius, cell_size, grading, count_of_intervals(length, cell_size));
  disc.cut(n_cuts);
  dealii::Triangulation<2> section;
  disc.make(section);
  dealii::Triangulation<3> mesh;
  const unsigned int n_axial = n_intervals(length, cell_size);
  dealii::GridGenerator::extrude_triangulation(section, n_axial + 1, length,
                                               mesh);
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
      face->set_boundary_id(
          cylinder_face_id(face->center(), radius, length, n_cuts));
  // A cyclic permutation of the axes keeps cells right-handed.
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &p)
      {
        const double local[3] = {p[0], p[1], p[2] - 0.5 * length};
        dealii::Point<3> q;
        for (unsigned int d = 0; d < 3; ++d)
          q[(axis + 1 + d) % 3] = local[d] + center[(axis + 1 + d) % 3];
        return q;
      },
      mesh);
  return extract_mesh(mesh);
}
} // namespace sabot
