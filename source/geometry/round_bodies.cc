// Balls and projectiles of hexahedra: six blocks of shells around a cube.
#include "sabot/geometry/round_bodies.h"

#include "sabot/base/text.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/geometry/particle_cloud.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sabot
{
namespace
{
constexpr double pi = 3.14159265358979323846;

/** The unit ball, or its upper half with a shaft below, as o-grid blocks. */
class Ball
{
public:
  /** @p n: cells across the core (even), @p m: shells. */
  Ball(const int n, const int m, const bool upper_half)
      : n(n), m(m), low(upper_half ? n / 2 : 0)
  {
    for (int k = low; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          add({{node(i, j, k, 0), node(i + 1, j, k, 0), node(i, j + 1, k, 0),
                node(i + 1, j + 1, k, 0), node(i, j, k + 1, 0),
                node(i + 1, j, k + 1, 0), node(i, j + 1, k + 1, 0),
                node(i + 1, j + 1, k + 1, 0)}});
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, n})
        if (axis < 2 || side == n || !upper_half)
          add_shells(axis, side);
  }

  /** Cells below the equator, @p n_levels deep to @p height < 0 (in the space
      of points()). */
  void extrude_equator(const int n_levels, const double height)
  {
    std::vector<std::array<unsigned int, 4>> quads;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        quads.push_back({{node(i, j, low, 0), node(i + 1, j, low, 0),
                          node(i, j + 1, low, 0), node(i + 1, j + 1, low, 0)}});
    for (int layer = 0; layer < m; ++layer)
      for (int i = 0; i < n; ++i)
        for (const int side : {0, n})
        {
          quads.push_back(
              {{node(i, side, low, layer), node(i + 1, side, low, layer),
                node(i, side, low, layer + 1),
                node(i + 1, side, low, layer + 1)}});
          quads.push_back(
              {{node(side, i, low, layer), node(side, i + 1, low, layer),
                node(side, i, low, layer + 1),
                node(side, i + 1, low, layer + 1)}});
        }
    std::map<std::array<unsigned int, 2>, unsigned int> below;
    const auto at = [&](const unsigned int base, const int level)
    {
      if (level == 0)
        return base;
      const auto found = below.emplace(
          std::array<unsigned int, 2>{{base, unsigned(level)}}, points.size());
      if (found.second)
      {
        dealii::Point<3> p = points[base];
        p[2] = height * level / n_levels;
        points.push_back(p);
      }
      return found.first->second;
    };
    for (int level = 0; level < n_levels; ++level)
      for (const auto &q : quads)
        add({{at(q[0], level + 1), at(q[1], level + 1), at(q[2], level + 1),
              at(q[3], level + 1), at(q[0], level), at(q[1], level),
              at(q[2], level), at(q[3], level)}});
  }

  /** Keep the half where x is not negative, or the quarter where @p sign y is
      not, either. Both planes are planes of the mesh, as n is even. */
  void cut(const unsigned int n_cuts, const double sign)
  {
    const double keep[2] = {1., sign};
    for (unsigned int d = 0; d < n_cuts; ++d)
      cells.erase(std::remove_if(cells.begin(), cells.end(),
                                 [&](const dealii::CellData<3> &cell)
                                 {
                                   double middle = 0.;
                                   for (const unsigned int v : cell.vertices)
                                     middle += points[v][d];
                                   return keep[d] * middle < 0.;
                                 }),
                  cells.end());
    if (n_cuts == 0)
      return;
    dealii::SubCellData none;
    dealii::GridTools::delete_unused_vertices(points, cells, none);
  }

  void make(dealii::Triangulation<3> &mesh)
  {
    // Right-handed: the lower four vertices change places with the upper.
    for (dealii::CellData<3> &cell : cells)
    {
      dealii::Tensor<1, 3> edge[3];
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          edge[d] += (v >> d & 1 ? 1. : -1.) *
                     dealii::Tensor<1, 3>(points[cell.vertices[v]]);
      if (dealii::cross_product_3d(edge[0], edge[1]) * edge[2] < 0.)
        std::swap_ranges(cell.vertices.begin(), cell.vertices.begin() + 4,
                         cell.vertices.begin() + 4);
    }
    dealii::GridTools::consistently_order_cells(cells);
    mesh.create_triangulation(points, cells, dealii::SubCellData());
  }

  std::vector<dealii::Point<3>> points;

private:
  void add(const std::array<unsigned int, 8> &corners)
  {
    dealii::CellData<3> cell;
    cell.vertices.assign(corners.begin(), corners.end());
    cells.push_back(cell);
  }

  /** Core lattice point, carried outwards to shell @p layer of m. */
  unsigned int node(const int i, const int j, const int k, const int layer)
  {
    const auto found =
        number.emplace(std::array<int, 4>{{i, j, k, layer}}, points.size());
    if (found.second)
    {
      const double s[3] = {2. * i / n - 1., 2. * j / n - 1., 2. * k / n - 1.};
      const double corner = 0.55 / std::sqrt(3.), bulge = 0.2;
      dealii::Point<3> core, rim;
      for (int d = 0; d < 3; ++d)
      {
        const double t = s[(d + 1) % 3], u = s[(d + 2) % 3];
        core[d] = corner * s[d] * (1. + bulge * (2. - t * t - u * u));
        rim[d] = std::tan(0.25 * pi * s[d]); // equal angles
      }
      const double f = double(layer) / m;
      points.push_back(layer == 0 ? core
                                  : core * (1. - f) + rim / rim.norm() * f);
    }
    return found.first->second;
  }

  void add_shells(const int axis, const int side)
  {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    int first[3] = {0, 0, low};
    for (int layer = 0; layer < m; ++layer)
      for (int q = first[b]; q < n; ++q)
        for (int p = first[a]; p < n; ++p)
        {
          std::array<unsigned int, 8> corners;
          for (int c = 0; c < 8; ++c)
          {
            int at[3];
            at[axis] = side;
            at[a] = p + (c & 1);
            at[b] = q + (c >> 1 & 1);
            corners[c] = node(at[0], at[1], at[2], layer + (c >> 2));
          }
          add(corners);
        }
  }

  const int n, m, low;
  std::vector<dealii::CellData<3>> cells;
  std::map<std::array<int, 4>, unsigned int> number;
};

/** On the planes of a cut, which go through the middle of the ball, the ids
    from @p first on. */
void name_cuts(dealii::Triangulation<3> &mesh, const unsigned int n_cuts,
               const unsigned int first)
{
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
      for (unsigned int d = 0; d < n_cuts; ++d)
        if (std::abs(face->center()[d]) < 1e-9 * face->diameter())
          face->set_boundary_id(first + d);
}

/** Cells across the core and shells for cells of about @p relative_size; of
    the upper half with @p n_levels of cells below, or of the whole. Throws
    TooManyItems. */
std::array<int, 2> divisions(const double relative_size,
                             const std::optional<double> n_levels)
{
  const double n = 2. * count_of_intervals(0.38, relative_size),
               m = count_of_intervals(0.5, relative_size);
  const double ball = n * n * (n + 6. * m), disc = n * n + 4. * n * m;
  check_memory_for(n_levels ? 0.5 * ball + *n_levels * disc : ball, Item::cell,
                   formatted("%.6g across the core, ", n) +
                       formatted("%.6g shells", m));
  return {{int(n), int(m)}};
}

double nose_radius(const ProjectileSpecification &p, const double z)
{
  const double R = p.radius, L = p.nose_length;
  if (p.nose == Nose::conical)
    return R * (1. - z / L);
  if (p.nose == Nose::spherical)
  {
    const double ball = (R * R + L * L) / (2. * L), height = ball - L + z;
    return std::sqrt(std::max(0., (ball - height) * (ball + height)));
  }
  const double S = (R * R + L * L) / (2. * R);
  return std::max(0., std::sqrt(S * S - z * z) - (S - R));
}

double nose_volume(const ProjectileSpecification &p)
{
  // Simpson's rule; r^2 is smooth up to the tip for all noses.
  constexpr int n = 1000;
  double sum = 0.;
  for (int i = 0; i <= n; ++i)
  {
    const double r = nose_radius(p, p.nose_length * i / n);
    sum += (i == 0 || i == n ? 1. : i % 2 == 1 ? 4. : 2.) * r * r;
  }
  return pi * sum * p.nose_length / (3. * n);
}
} // namespace

HexMesh make_sphere(const double radius, const std::array<double, 3> &center,
                    const double cell_size, const unsigned int n_cuts)
{
  const auto n = divisions(cell_size / radius, std::nullopt);
  Ball ball(n[0], n[1], false);
  ball.cut(n_cuts, 1.);
  dealii::Triangulation<3> mesh;
  ball.make(mesh);
  name_cuts(mesh, n_cuts, 1);
  const double exact = 4. / 3. * pi / (1 << n_cuts);
  dealii::GridTools::scale(
      radius * std::cbrt(exact / dealii::GridTools::volume(mesh)), mesh);
  dealii::GridTools::shift(
      dealii::Tensor<1, 3>({center[0], center[1], center[2]}), mesh);
  return extract_mesh(mesh);
}

HexMesh make_projectile(const ProjectileSpecification &spec)
{
  const double R = spec.radius, L = spec.nose_length, shaft = spec.shaft_length;
  const auto n =
      divisions(spec.cell_size / R, count_of_intervals(shaft, spec.cell_size));
  Ball ball(n[0], n[1], true);
  for (dealii::Point<3> &p : ball.points)
  {
    const double z = std::min(1., p[2]);
    const double sphere = std::sqrt(std::max(0., 1. - z * z));
    const double across =
        sphere > 1e-9 ? nose_radius(spec, z * L) / sphere : 0.;
    p = dealii::Point<3>(p[0] * across, p[1] * across, z * L);
  }
  ball.extrude_equator(n_intervals(shaft, spec.cell_size), -shaft);
  const double sign = spec.towards_positive ? 1. : -1.;
  ball.cut(spec.n_cuts, sign);
  dealii::Triangulation<3> mesh;
  ball.make(mesh);
  const double across =
      std::sqrt((pi * R * R * shaft + nose_volume(spec)) / (1 << spec.n_cuts) /
                dealii::GridTools::volume(mesh));
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
      face->set_boundary_id(face->center()[2] < -shaft * (1. - 1e-9) ? 0 : 1);
  name_cuts(mesh, spec.n_cuts, 2);
  // A cyclic permutation of the axes keeps cells right-handed; so does turning
  // the nose round by half a turn.
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &p)
      {
        const double local[3] = {p[0] * across, sign * p[1] * across,
                                 sign * (p[2] + 0.5 * (shaft - L))};
        dealii::Point<3> q;
        for (unsigned int d = 0; d < 3; ++d)
          q[(spec.axis + 1 + d) % 3] =
              local[d] + spec.center[(spec.axis + 1 + d) % 3];
        return q;
      },
      mesh);
  return extract_mesh(mesh);
}
} // namespace sabot
