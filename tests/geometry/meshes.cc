// Meshes: volumes, boundaries, growth.
#include "sabot/base/error.h"
#include "sabot/geometry/carving.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/mesh_import.h"
#include "sabot/geometry/particle_cloud.h"
#include "sabot/geometry/round_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{
using namespace sabot;

double volume(const HexMesh &mesh)
{
  double sum = 0.;
  for (const double v : mesh.volume)
  {
    EXPECT_GT(v, 0.);
    sum += v;
  }
  return sum;
}

TEST(RoundBodies, a_sphere_has_its_volume_and_good_cells)
{
  const double exact = 4. / 3. * M_PI * std::pow(5e-3, 3);
  for (const double h : {2.5e-3, 1.2e-3})
  {
    const HexMesh mesh = make_sphere(5e-3, {{1e-3, 2e-3, 3e-3}}, h);
    EXPECT_NEAR(volume(mesh), exact, 1e-12 * exact);
    const MeshQuality quality = measure_quality(mesh);
    EXPECT_GT(quality.scaled_jacobian, 0.4) << quality.text();
    EXPECT_LT(quality.aspect_ratio, 4.) << quality.text();
    double low = 1., high = 0.;
    for (const auto &face : mesh.boundary_faces)
      for (const GlobalIndex a : face)
      {
        const auto &p = mesh.nodes[a];
        const double r =
            std::sqrt(std::pow(p[0] - 1e-3, 2) + std::pow(p[1] - 2e-3, 2) +
                      std::pow(p[2] - 3e-3, 2));
        low = std::min(low, r);
        high = std::max(high, r);
      }
    // Facets of angle t lie t^2/6 below their corners on average.
    const double t = M_PI / 2. / (h > 2e-3 ? 2. : 4.);
    EXPECT_NEAR(high, low, 1e-14);
    EXPECT_GT(high, 5e-3);
    EXPECT_LT(high, 5e-3 * (1. + t * t / 6.));
  }
}

TEST(RoundBodies, a_graded_cylinder_is_fine_in_the_middle_only)
{
  CylinderGrading grading;
  grading.core_radius = 6e-3;
  grading.growth_ratio = 1.25;
  grading.coarsest_cell_size = 6e-3;
  const double exact = M_PI * 2500e-6 * 10e-3;
  for (const unsigned int n_cuts : {0u, 2u})
  {
    const HexMesh mesh =
        make_cylinder(50e-3, 10e-3, 2, {{0., 0., 0.}}, 1e-3, n_cuts, grading);
    EXPECT_NEAR(volume(mesh), n_cuts > 0 ? exact / 4. : exact, 1e-12 * exact);
    EXPECT_LT(mesh.cells.size(), n_cuts > 0 ? 4000u : 16000u);
    EXPECT_GT(measure_quality(mesh).scaled_jacobian, 0.5)
        << measure_quality(mesh).text();
    EXPECT_LT(measure_quality(mesh).aspect_ratio, 8.)
        << measure_quality(mesh).text();
  }
}

TEST(RoundBodies, noses_have_their_volume_and_length)
{
  ProjectileSpecification p;
  p.radius = 5e-3;
  p.cell_size = 1e-3;
  // Tangent ogive: V = pi (L S^2 - L^3/3 - (S - R) S^2 asin(L/S)).
  const double S = 12.5e-3, L = 10e-3, R = 5e-3;
  const double ogive =
      M_PI * (L * S * S - L * L * L / 3. - (S - R) * S * S * std::asin(L / S));
  // A cap: V = pi H (3 R^2 + H^2)/6.
  const double H = 3e-3, cap = M_PI * H * (3. * R * R + H * H) / 6.;
  const double expected[] = {M_PI * R * R * L / 3., ogive, cap};
  int n = 0;
  for (const Nose nose : {Nose::conical, Nose::ogive, Nose::spherical})
    for (const bool positive : {true, false})
    {
      p.nose = nose;
      p.nose_length = nose == Nose::spherical ? H : L;
      p.shaft_length = 30e-3 - p.nose_length;
      p.axis = n % 3;
      p.towards_positive = positive;
      p.center = {{1e-3, 2e-3, 3e-3}};
      const HexMesh mesh = make_projectile(p);
      const double exact = M_PI * R * R * p.shaft_length + expected[n / 2];
      EXPECT_NEAR(volume(mesh), exact, 1e-8 * exact);
      double low = 1., high = -1.;
      for (const auto &x : mesh.nodes)
      {
        low = std::min(low, x[p.axis]);
        high = std::max(high, x[p.axis]);
      }
      EXPECT_NEAR(high - p.center[p.axis], 15e-3, 1e-12);
      EXPECT_NEAR(low - p.center[p.axis], -15e-3, 1e-12);
      const double end = positive ? -15e-3 : 15e-3;
      for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
        if (mesh.boundary_id[f] == 0)
        {
          EXPECT_NEAR(mesh.nodes[mesh.boundary_faces[f][0]][p.axis],
                      p.center[p.axis] + end, 1e-12);
        }
      EXPECT_GT(measure_quality(mesh).scaled_jacobian, 0.1)
          << measure_quality(mesh).text();
      ++n;
    }
}

/** Integral of the outward normal over the boundary: 0 where it is closed. */
std::array<double, 3> area(const HexMesh &mesh)
{
  std::array<double, 3> sum{{0., 0., 0.}};
  for (const auto &f : mesh.boundary_faces)
    for (int d = 0; d < 3; ++d)
    {
      const auto x = [&](const int a, const int c)
      { return mesh.nodes[f[a]][(d + c) % 3]; };
      sum[d] += 0.5 * ((x(2, 1) - x(0, 1)) * (x(3, 2) - x(1, 2)) -
                       (x(2, 2) - x(0, 2)) * (x(3, 1) - x(1, 1)));
    }
  return sum;
}

TEST(Carving, the_parts_fill_the_body_and_share_their_nodes)
{
  const double R = 10e-3, r = 3e-3, L = 4e-3, h = 0.8e-3;
  CylinderGrading grading;
  grading.growth_ratio = 1.3;
  grading.zone_radius = r;
  const HexMesh whole = make_cylinder(R, L, 2, {{0., 0., 0.}}, h, 0, grading);
  EXPECT_NEAR(volume(whole), M_PI * R * R * L, 1e-12 * volume(whole));
  EXPECT_GT(measure_quality(whole).scaled_jacobian, 0.4);
  ZoneShape zone;
  zone.axis = 2;
  zone.size = {{2. * r, 2. * r, 2. * L}};
  const CarvedMesh parts = carve(whole, zone, 3, "Bodies/core/Center");
  // The zone is a cylinder of the exact volume, as its circle is a mesh line.
  EXPECT_NEAR(volume(parts.zone), M_PI * r * r * L, 1e-12 * volume(whole));
  EXPECT_NEAR(volume(parts.rest) + volume(parts.zone), volume(whole),
              1e-12 * volume(whole));
  for (const HexMesh *mesh : {&parts.rest, &parts.zone})
    for (const double a : area(*mesh))
      EXPECT_NEAR(a, 0., 1e-12 * R * R);
  std::set<std::array<double, 3>> of_rest(parts.rest.nodes.begin(),
                                          parts.rest.nodes.end()),
      shared, on_interface;
  for (const auto &x : parts.zone.nodes)
    if (of_rest.count(x) > 0)
      shared.insert(x);
  for (std::size_t f = 0; f < parts.zone.boundary_faces.size(); ++f)
    if (parts.zone.boundary_id[f] == 3)
      for (const GlobalIndex a : parts.zone.boundary_faces[f])
        on_interface.insert(parts.zone.nodes[a]);
  EXPECT_EQ(shared, on_interface);
  EXPECT_EQ(parts.rest.nodes.size() + parts.zone.nodes.size(),
            whole.nodes.size() + shared.size());
  // Particles have the mass of the cells they replace.
  double sum = 0.;
  for (const double v : make_mesh_cloud(parts.zone).volume)
    sum += v;
  EXPECT_NEAR(sum, volume(parts.zone), 1e-12 * volume(whole));
}

TEST(Carving, an_empty_part_is_refused)
{
  BoxSpecification b;
  b.size = {{4., 4., 4.}};
  b.cell_size = 1.;
  const HexMesh mesh = make_graded_box(b);
  ZoneShape zone;
  zone.size = {{10., 10., 10.}};
  EXPECT_THROW(carve(mesh, zone, 6, "a"), InputError);
  zone.center = {{20., 0., 0.}};
  EXPECT_THROW(carve(mesh, zone, 6, "a"), InputError);
}

TEST(MeshQuality, sees_an_inverted_cell)
{
  BoxSpecification b;
  b.size = {{1., 1., 1.}};
  b.cell_size = 1.;
  HexMesh mesh = make_graded_box(b);
  EXPECT_NEAR(measure_quality(mesh).scaled_jacobian, 1., 1e-14);
  mesh.nodes[mesh.cells[0][0]] = {{0.4, 0.4, 0.4}};
  EXPECT_LT(measure_quality(mesh).scaled_jacobian, 0.);
}
} // namespace
