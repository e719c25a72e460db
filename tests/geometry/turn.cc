// Turned bodies: places, masses and directions follow exactly.
#include "sabot/geometry/turn.h"
#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/geometry/boundary_planes.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/particle_cloud.h"
#include "sabot/geometry/round_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace
{
using namespace sabot;

constexpr double degree = M_PI / 180.;

HexMesh block()
{
  BoxSpecification box;
  box.center = {{1e-3, 2e-3, 3e-3}};
  box.size = {{4e-3, 2e-3, 1e-3}};
  box.cell_size = 0.5e-3;
  return make_graded_box(box);
}

Vec to_vec(const std::array<double, 3> &x)
{
  return vec(x[0], x[1], x[2]);
}

double volume(const HexMesh &mesh)
{
  return std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.);
}

TEST(Turn, right_angles_change_coordinates_exactly)
{
  const HexMesh mesh = block();
  HexMesh turned = mesh;
  Turn::about({{0., 0., 3.}}, 90. * degree, {{0., 0., 0.}}).apply(turned);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
  {
    EXPECT_EQ(turned.nodes[a][0], -mesh.nodes[a][1]);
    EXPECT_EQ(turned.nodes[a][1], mesh.nodes[a][0]);
    EXPECT_EQ(turned.nodes[a][2], mesh.nodes[a][2]);
  }
  EXPECT_EQ(turned.volume, mesh.volume);
  EXPECT_EQ(turned.cells, mesh.cells);
  EXPECT_EQ(turned.boundary_id, mesh.boundary_id);
  // The face -x of the body looks along -y now.
  EXPECT_EQ(plane_axis(mesh, 0), 0);
  EXPECT_EQ(plane_axis(turned, 0), 1);
}

TEST(Turn, mean_gradients_follow)
{
  HexMesh mesh = block();
  Turn::about({{1., 2., -1.}}, 33. * degree, {{1e-3, 0., 2e-3}}).apply(mesh);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    Mat sum = Mat::zero();
    const MeanGradients mean = mean_gradients(mesh, c);
    EXPECT_NEAR(mean.volume, mesh.volume[c], 1e-12 * mesh.volume[c]);
    for (int a = 0; a < 8; ++a)
      add_outer(sum, to_vec(mesh.nodes[mesh.cells[c][a]]), to_vec(mean.B[a]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(sum(i, j), i == j ? 1. : 0., 1e-12);
  }
}

TEST(Turn, about_an_axis_planes_across_it_stay)
{
  HexMesh mesh = block();
  const double y = mesh.nodes[mesh.boundary_faces[0][0]][1];
  Turn::about({{0., 1., 0.}}, 30. * degree, {{1e-3, y, 3e-3}}).apply(mesh);
  EXPECT_EQ(plane_axis(mesh, 2), 1);
  EXPECT_EQ(plane_axis(mesh, 3), 1);
  EXPECT_FALSE(plane_axis(mesh, 0).has_value());
  EXPECT_FALSE(plane_axis(mesh, 4).has_value());
}

TEST(Turn, there_and_back)
{
  const Turn turn = Turn::by_angles(20. * degree, -40. * degree, 70. * degree,
                                    {{1., 2., 3.}});
  const std::array<double, 3> x = {{0.3, -0.2, 5.}},
                              back = turn.origin(turn.place(x));
  for (int d = 0; d < 3; ++d)
    EXPECT_NEAR(back[d], x[d], 1e-14);
}

TEST(Turn, yaw_pitch_and_roll_are_about_fixed_axes_from_the_last_on)
{
  const double yaw = 0.3, pitch = 0.4, roll = 0.5;
  const std::array<double, 3> origin = {{0., 0., 0.}};
  const Turn at_once = Turn::by_angles(yaw, pitch, roll, origin),
             z = Turn::about({{0., 0., 1.}}, yaw, origin),
             y = Turn::about({{0., 1., 0.}}, pitch, origin),
             x = Turn::about({{1., 0., 0.}}, roll, origin);
  const Vec v = vec(1., -2., 0.5),
            difference =
                at_once.direction(v) - z.direction(y.direction(x.direction(v)));
  EXPECT_LT(norm(difference), 1e-14);
}

TEST(Turn, a_lattice_keeps_its_distances_along_its_own_directions)
{
  const std::array<double, 3> size = {{4e-3, 2e-3, 1e-3}};
  ParticleCloud cloud =
      make_box_cloud({{0., 0., 0.}}, size, {{1e-3, 0.5e-3, 0.25e-3}});
  const ParticleCloud before = cloud;
  const Turn turn = Turn::about({{1., 1., 0.}}, 50. * degree, {{0., 0., 0.}});
  turn.apply(cloud);
  EXPECT_EQ(cloud.volume, before.volume);
  ASSERT_EQ(cloud.shape.size(), cloud.position.size());
  // Neighbors a step away stand one unit away in every direction.
  for (int d = 0; d < 3; ++d)
  {
    Vec step = {};
    step[d] = before.spacing[d];
    EXPECT_NEAR(norm(inverse(cloud.shape[0]) * turn.direction(step)), 1.,
                1e-12);
    EXPECT_FALSE(cloud.face_axis[2 * d].has_value());
  }
  const AlignedVector<Vec> normal = outward_normals(cloud, 0),
                           was = outward_normals(before, 0);
  for (std::size_t i = 0; i < normal.size(); ++i)
    EXPECT_LT(norm(normal[i] - turn.direction(was[i])), 1e-12);
}

TEST(Turn, right_angles_keep_planes_of_a_lattice)
{
  ParticleCloud cloud =
      make_box_cloud({{0., 0., 0.}}, {{4e-3, 2e-3, 1e-3}}, 0.5e-3);
  Turn::about({{1., 0., 0.}}, -90. * degree, {{0., 0., 0.}}).apply(cloud);
  const std::vector<std::optional<int>> expected = {0, 0, 2, 2, 1, 1};
  EXPECT_EQ(cloud.face_axis, expected);
}

TEST(Turn, entries_that_contradict_are_refused)
{
  const auto parse =
      [](const std::vector<std::pair<std::string, std::string>> &entries)
  {
    Parameters prm;
    prm.declare_entry("Center", "1 mm, 2 mm, 3 mm",
                      quantities(Dimension::length, 3, 3), "");
    Turn::declare(prm);
    for (const auto &entry : entries)
      EXPECT_TRUE(prm.set(entry.first, entry.second)) << entry.first;
    return Turn::parse(prm, "Bodies/b");
  };
  EXPECT_TRUE(parse({}).is_none());
  EXPECT_THROW(parse({{"Rotation angle", "10 deg"},
                      {"Yaw pitch roll", "0 deg, 1 deg, 0 deg"}}),
               InputError);
  EXPECT_THROW(
      parse({{"Rotation angle", "10 deg"}, {"Rotation axis", "0, 0, 0"}}),
      InputError);
  // About its center unless another point is given.
  const auto stays =
      parse({{"Rotation angle", "10 deg"}}).place({{1e-3, 2e-3, 3e-3}});
  EXPECT_EQ(stays[0], 1e-3);
  EXPECT_EQ(stays[1], 2e-3);
  const auto moves = parse({{"Yaw pitch roll", "90 deg, 0 deg, 0 deg"},
                            {"Rotation center", "0 m, 0 m, 0 m"}})
                         .place({{1e-3, 2e-3, 3e-3}});
  EXPECT_EQ(moves[0], -2e-3);
  EXPECT_EQ(moves[1], 1e-3);
}

TEST(RoundBodies, sectors_are_parts_of_the_whole)
{
  ProjectileSpecification nose;
  nose.radius = 4e-3;
  nose.shaft_length = 10e-3;
  nose.nose_length = 6e-3;
  nose.nose = Nose::ogive;
  nose.cell_size = 1.5e-3;
  nose.center = {{1e-3, 2e-3, 3e-3}};
  for (const bool towards_positive : {true, false})
    for (unsigned int axis = 0; axis < 3; ++axis)
    {
      nose.towards_positive = towards_positive;
      nose.axis = axis;
      nose.n_cuts = 0;
      const double whole = volume(make_projectile(nose));
      for (unsigned int cuts = 1; cuts <= 2; ++cuts)
      {
        nose.n_cuts = cuts;
        const HexMesh mesh = make_projectile(nose);
        EXPECT_NEAR(volume(mesh), whole / (1 << cuts), 1e-9 * whole);
        for (unsigned int cut = 0; cut < cuts; ++cut)
        {
          const int across = (axis + 1 + cut) % 3;
          EXPECT_EQ(plane_axis(mesh, 2 + cut), across);
          for (const auto &x : mesh.nodes)
            EXPECT_GE(x[across], nose.center[across]);
        }
      }
    }
  const double whole = volume(make_sphere(4e-3, nose.center, 1e-3));
  for (unsigned int cuts = 1; cuts <= 2; ++cuts)
  {
    const HexMesh mesh = make_sphere(4e-3, nose.center, 1e-3, cuts);
    EXPECT_NEAR(volume(mesh), whole / (1 << cuts), 1e-9 * whole);
    for (unsigned int cut = 0; cut < cuts; ++cut)
      EXPECT_EQ(plane_axis(mesh, 1 + cut), int(cut));
  }
}
} // namespace
