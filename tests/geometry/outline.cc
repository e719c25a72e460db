// Shapes before the run: overlaps, meetings, slivers, and counts of cells.
#include "sabot/geometry/outline.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/mesh_layers.h"
#include "sabot/geometry/particle_cloud.h"
#include "sabot/geometry/round_bodies.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

HexMesh box(const std::array<double, 3> &size,
            const std::array<double, 3> &center, const double cell)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = cell;
  return make_graded_box(b);
}

Outline cube(const double x, const double y = 0., const double z = 0.)
{
  return outline_of(box({{2., 2., 2.}}, {{x, y, z}}, 1.), {});
}

Outline ball(const double radius, const std::array<double, 3> &center)
{
  return outline_of(make_sphere(radius, center, 0.25 * radius), {});
}

TEST(Outline, skins_are_closed_and_look_outwards)
{
  const ParticleCloud lattice =
      make_box_cloud({{1., 2., 3.}}, {{2., 3., 4.}}, {{1., 0.5, 2.}});
  const HexMesh mesh = make_cylinder(1., 2., 2, {{0., 0., 1.}}, 0.3);
  for (const auto &[outline, volume] :
       {std::make_pair(outline_of(lattice, 0), 24.),
        std::make_pair(outline_of(mesh, {}), 2. * M_PI),
        std::make_pair(outline_of(make_mesh_cloud(mesh), 0), 2. * M_PI)})
  {
    // By Gauss: a third of the integral of x . n; faces without warp.
    double integral = 0.;
    for (const auto &face : outline.faces)
    {
      const auto &x = outline.points;
      const Vec area =
          0.5 * cross(x[face[2]] - x[face[0]], x[face[3]] - x[face[1]]);
      integral += dot(area, x[face[0]]) / 3.;
    }
    EXPECT_NEAR(integral, volume, 1e-9 * volume);
  }
  const Outline cut = outline_of(lattice, 1u << 4);
  EXPECT_EQ(std::count(cut.is_cut.begin(), cut.is_cut.end(), 1), 2 * 6);
}

TEST(Outline, chords_of_round_bodies_and_edges_of_boxes)
{
  EXPECT_EQ(cube(0.).chord_error(), 0.);
  // Twice the sagitta of an arc of 1/n of the circle, a few times finer.
  const Outline rod =
      outline_of(make_cylinder(1., 1., 2, {{0., 0., 0.}}, 0.2), {});
  const double sagitta = 0.2 * 0.2 / 8.;
  EXPECT_GT(rod.chord_error(), sagitta);
  EXPECT_LT(rod.chord_error(), 8. * sagitta);
}

TEST(Outline, overlaps_by_the_deepest_point)
{
  EXPECT_EQ(deepest_overlap(cube(0.), cube(2.1)).depth, 0.);
  EXPECT_LT(deepest_overlap(cube(0.), cube(2.)).depth, 1e-12);
  const Overlap overlap = deepest_overlap(cube(0.), cube(1.9, 0.3, 0.2));
  EXPECT_NEAR(overlap.depth, 0.1, 1e-12);
  EXPECT_NEAR(overlap.place[0], 0.95, 0.06);
  // Boxes around them overlap, they do not; and one within the other.
  EXPECT_EQ(
      deepest_overlap(ball(5., {{0., 0., 0.}}), ball(5., {{6., 6., 6.}})).depth,
      0.);
  EXPECT_NEAR(
      deepest_overlap(ball(5., {{0., 0., 0.}}), ball(1., {{1., 0., 0.}})).depth,
      4.8, 0.3);
}

TEST(Outline, meets_where_faces_are_in_the_way)
{
  const Vec x = vec(1., 0., 0.), diagonal = std::sqrt(0.5) * vec(1., 1., 0.);
  const auto way = way_to_meeting(cube(0.), cube(5.), x, 10.);
  ASSERT_TRUE(way);
  EXPECT_NEAR(*way, 3., 1e-12);
  EXPECT_FALSE(way_to_meeting(cube(0.), cube(5.), x, 2.9));
  EXPECT_FALSE(way_to_meeting(cube(0.), cube(5.), -x, 10.));
  EXPECT_FALSE(way_to_meeting(cube(0.), cube(5., 2.1), x, 10.));
  // Side by side they slide; what touches and parts does not meet.
  EXPECT_FALSE(way_to_meeting(cube(0.), cube(5., 2.), x, 10.));
  EXPECT_FALSE(way_to_meeting(cube(0.), cube(2.), -x, 10.));
  EXPECT_NEAR(*way_to_meeting(cube(0.), cube(2.), x, 10.), 0., 1e-12);
  const auto slanted = way_to_meeting(cube(0.), cube(5., 4.5), diagonal, 10.);
  ASSERT_TRUE(slanted);
  EXPECT_NEAR(*slanted, 3. * std::sqrt(2.), 1e-9);
  // A small body in the middle of a large face.
  const Outline grain =
      outline_of(box({{.1, .1, .1}}, {{-3., .2, .3}}, .1), {});
  EXPECT_NEAR(*way_to_meeting(grain, cube(0.), x, 10.), 1.95, 1e-9);
  EXPECT_NEAR(*way_to_meeting(cube(0.), grain, -x, 10.), 1.95, 1e-9);
  // Planes of symmetry are no obstacles.
  const Outline cut = outline_of(box({{2., 2., 2.}}, {{5., 0., 0.}}, 1.), {0});
  EXPECT_FALSE(way_to_meeting(cube(0.), cut, x, 3.5));
  // Balls, off the line of their centers by one radius.
  const auto grazing = way_to_meeting(ball(1., {{0., 0., 0.}}),
                                      ball(1., {{5., 1., 0.}}), x, 10.);
  ASSERT_TRUE(grazing);
  EXPECT_NEAR(*grazing, 5. - std::sqrt(3.), 0.1);
}

TEST(Outline, comes_near_and_touches)
{
  const Vec x = vec(1., 0., 0.);
  EXPECT_TRUE(may_come_near(cube(0.), cube(5., 2.5), x, 10., 1.));
  EXPECT_FALSE(may_come_near(cube(0.), cube(5., 3.5), x, 10., 1.));
  EXPECT_FALSE(may_come_near(cube(0.), cube(5.), x, 1.5, 1.));
  EXPECT_FALSE(may_come_near(cube(0.), cube(5.), -x, 10., 1.));
  EXPECT_TRUE(touch(cube(0.), cube(2., 0.5), 1e-6));
  EXPECT_FALSE(touch(cube(0.), cube(2.01), 1e-6));
  EXPECT_FALSE(touch(cube(0.), cube(2., 2.), 1e-6)); // along an edge
}

TEST(Layers, of_slivers_are_found_and_graded_meshes_pass)
{
  BoxSpecification plate;
  plate.size = {{20., 20., 10.}};
  plate.cell_size = 1.;
  plate.growth_ratio = 3.;
  plate.has_zone = true;
  plate.zone_is_cut = false;
  plate.zone_size = {{4., 4., 10.}};
  EXPECT_EQ(find_thin_layer(make_graded_box(plate)).n_cells, 0u);
  plate.zone_size[2] = 9.8;
  const ThinLayer layer = find_thin_layer(make_graded_box(plate));
  EXPECT_NEAR(layer.height, 0.1, 1e-12);
  EXPECT_NEAR(layer.neighbor, 0.98, 1e-12);
  EXPECT_NEAR(std::abs(layer.place[2]), 4.95, 1e-9);
  EXPECT_GT(layer.n_cells, 10u);
  for (const HexMesh &mesh : {make_sphere(5., {{0., 0., 0.}}, 0.5),
                              make_cylinder(5., 10., 2, {{0., 0., 0.}}, 0.7)})
    EXPECT_EQ(find_thin_layer(mesh).n_cells, 0u);
}

TEST(Counts, of_grown_cells_are_those_that_are_made)
{
  for (const double length : {0.5, 3., 10., 57.3})
    for (const double growth : {1., 1.05, 1.3, 3.})
      for (const double coarsest : {1., 2.5, unbounded})
      {
        const double made = growing_sizes(length, 1., coarsest, growth).size();
        const double n = count_of_growing(length, 1., coarsest, growth);
        EXPECT_GE(n, made) << length << " " << growth << " " << coarsest;
        EXPECT_LE(n, made + 3.) << length << " " << growth << " " << coarsest;
      }
  EXPECT_THROW(check_memory_for({{1e4, 1e4, 1e4}}, Item::cell), TooManyItems);
  EXPECT_NO_THROW(check_memory_for({{10., 10., 10.}}, Item::particle));
  EXPECT_THROW(make_sphere(1., {{0., 0., 0.}}, 1e-5), TooManyItems);
  EXPECT_THROW(make_box_cloud({{0., 0., 0.}}, {{1., 1., 1.}}, 1e-5),
               TooManyItems);
}
} // namespace
