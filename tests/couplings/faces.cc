// Normals of surfaces of faces, and what they do for the symmetry of contact.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "sabot/geometry/edge_distance.h"
#include "sabot/geometry/round_bodies.h"
#include "sabot/kernels/face_hit.h"
#include "verification/world.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using namespace sabot;

constexpr double h = 1e-3;

HexMesh brick(const std::array<double, 3> &size,
              const std::array<double, 3> &center, const double cell)
{
  BoxSpecification box;
  box.size = size;
  box.center = center;
  box.cell_size = cell;
  return make_graded_box(box);
}

TEST(Faces, a_line_meets_a_face_with_the_weights_of_the_place)
{
  const std::array<Vec, 4> square = {
      {vec(0, 0, 0), vec(2, 0, 0), vec(2, 2, 0), vec(0, 2, 0)}};
  const Vec up = vec(0, 0, 1);
  FaceHit hit;
  EXPECT_TRUE(hit_face(vec(0.5, 1.2, -0.3), up, square, hit));
  EXPECT_DOUBLE_EQ(hit.ahead, 0.3);
  Vec foot = {};
  double sum = 0.;
  for (int a = 0; a < 4; ++a)
  {
    foot += hit.weight[a] * square[a];
    sum += hit.weight[a];
  }
  EXPECT_NEAR(sum, 1., 1e-15);
  EXPECT_NEAR(norm(foot - vec(0.5, 1.2, 0.)), 0., 1e-15);
  // From outside, along a slope, beyond the rim, from behind.
  FaceHit above;
  EXPECT_TRUE(hit_face(vec(1., 1., 0.2), up, square, above));
  EXPECT_DOUBLE_EQ(above.ahead, -0.2);
  FaceHit sloped;
  EXPECT_TRUE(hit_face(vec(1., 1., -0.3), vec(0.6, 0., 0.8), square, sloped));
  EXPECT_DOUBLE_EQ(sloped.ahead, 0.375);
  FaceHit none;
  EXPECT_FALSE(hit_face(vec(2.001, 1., -0.1), up, square, none));
  EXPECT_FALSE(hit_face(vec(1., 1., -0.1), -1. * up, square, none));
  // A closer one stays.
  FaceHit closer;
  closer.ahead = 0.1;
  EXPECT_FALSE(hit_face(vec(1., 1., -0.3), up, square, closer));
  // On a shared edge both faces say the same.
  const std::array<Vec, 4> next = {
      {vec(2, 0, 0), vec(4, 0, 0), vec(4, 2, 0), vec(2, 2, 0)}};
  FaceHit left, right;
  EXPECT_TRUE(hit_face(vec(2., 0.7, -0.1), up, square, left));
  EXPECT_TRUE(hit_face(vec(2., 0.7, -0.1), up, next, right));
  EXPECT_NEAR(left.weight[1], right.weight[0], 1e-14);
  EXPECT_NEAR(left.weight[2], right.weight[3], 1e-14);
}

TEST(Faces, the_common_normal_is_that_of_the_surer_side)
{
  const auto tilted = [](const double angle, const double spread) {
    return SmoothNormal{vec(std::sin(angle), 0., std::cos(angle)), spread};
  };
  const auto down = [](const double angle, const double spread) {
    return SmoothNormal{vec(-std::sin(angle), 0., -std::cos(angle)), spread};
  };
  // A plane decides, whichever side it is on.
  EXPECT_NEAR(common_normal(tilted(0., 0.), down(0.1, 1e-2))[0], 0., 1e-12);
  EXPECT_NEAR(common_normal(tilted(0.1, 1e-2), down(0., 0.))[0], 0., 1e-12);
  // Equal ones share, edges have no say.
  EXPECT_NEAR(common_normal(tilted(0.1, 1e-2), down(-0.1, 1e-2))[0], 0., 1e-12);
  EXPECT_DOUBLE_EQ(common_normal(tilted(0.1, 1e-2), down(-0.5, 0.59))[0],
                   std::sin(0.1));
  // Of two planes the one that goes on further, alone from a spacing more on.
  const auto plane = [&](SmoothNormal normal, const double reach)
  {
    normal.reach = reach;
    return normal;
  };
  const SmoothNormal one = tilted(0.3, 1e-15), other = down(0., 0.);
  EXPECT_NEAR(common_normal(plane(one, 2.), plane(other, 9.))[0], 0., 1e-14);
  EXPECT_NEAR(common_normal(plane(one, 4.), plane(other, 2.))[0], std::sin(0.3),
              1e-14);
  EXPECT_NEAR(common_normal(plane(one, 2.), plane(other, 2.))[0],
              std::sin(0.15), 1e-2);
  // Which faces a node may meet: within 40 degrees of those in which it is the
  // foremost of its body.
  EXPECT_NEAR(least_cosine_of_met_faces({vec(0, 0, 1), 0.}),
              std::cos(40. * M_PI / 180.), 1e-3);
  EXPECT_NEAR(least_cosine_of_met_faces({vec(0, 0, 1), 2. - std::sqrt(2.)}),
              std::cos(85. * M_PI / 180.), 1e-3);
}

TEST(Faces, planes_go_on_to_their_edges)
{
  const HexMesh mesh = brick({{8e-3, 4e-3, 4e-3}}, {{0., 0., 0.}}, h);
  const std::vector<double> distance = edge_distances(mesh);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
  {
    const auto &p = mesh.nodes[a];
    std::array<double, 3> in{
        {4e-3 - std::abs(p[0]), 2e-3 - std::abs(p[1]), 2e-3 - std::abs(p[2])}};
    std::sort(in.begin(), in.end());
    if (in[0] < 1e-9) // on a face, this far from its edges
    {
      EXPECT_NEAR(distance[a], in[1], 1e-12);
    }
  }
  // A ball has no planes.
  const HexMesh ball = make_sphere(5e-3, {{0., 0., 0.}}, 1e-3);
  for (const double way : edge_distances(ball))
    EXPECT_EQ(way, 0.);
}

/** The normals of a body's surface, alone. */
struct Surface
{
  World world;
  NodeHalo halo;
  SurfaceNormals::Corners corners;
  SurfaceNormals normals{halo, corners};

  explicit Surface(const HexMesh &mesh)
  {
    world.bodies.push_back(std::make_unique<RigidBody>(
        "body", 0, mesh, elastic(), RigidOptions()));
    world.distribute();
    const Body &body = *world.bodies[0];
    const ContactSurface surface = body.contact_surface();
    const auto key = [&](const std::size_t i) {
      return NodeKey{0, 0, body.nodes().global_id[i]};
    };
    std::vector<NodeKey> keys;
    for (const auto &face : surface.faces)
      for (const std::size_t a : face)
        keys.push_back(key(a));
    halo.build(world.pointers(), keys, MPI_COMM_WORLD);
    halo.update();
    for (const auto &face : surface.faces)
    {
      corners.emplace_back();
      for (int a = 0; a < 4; ++a)
        corners.back()[a] = halo.slot(key(face[a]));
    }
    normals.build({{}}, 1e-9, {});
  }
};

TEST(Faces, normals_of_a_sphere_are_smooth_and_those_of_a_box_sharp)
{
  const double R = 5e-3;
  const Surface sphere(make_sphere(R, {{0., 0., 0.}}, 0.8e-3));
  double worst = 0., worst_facet = 0.;
  for (std::size_t f = 0; f < sphere.corners.size(); ++f)
    for (const std::array<double, 4> weight :
         {std::array<double, 4>{{1., 0., 0., 0.}},
          {{0.5, 0.5, 0., 0.}},
          {{0.25, 0.25, 0.25, 0.25}},
          {{0.1, 0.2, 0.4, 0.3}}})
    {
      Vec x[4], place = {};
      for (int a = 0; a < 4; ++a)
      {
        x[a] = sphere.halo.position[sphere.corners[f][a]];
        place += weight[a] * x[a];
      }
      const Vec radial = (1. / norm(place)) * place,
                area = cross(x[2] - x[0], x[3] - x[1]);
      worst = std::max(
          worst, norm(sphere.normals.of_face(f, weight).direction - radial));
      worst_facet =
          std::max(worst_facet, norm((1. / norm(area)) * area - radial));
    }
  // Facets are up to 11 degrees off, their means 3 where cells are uneven.
  EXPECT_GT(worst_facet, 0.1);
  EXPECT_LT(worst, 0.05);

  const Surface box(brick({{3e-3, 3e-3, 3e-3}}, {{0., 0., 0.}}, h));
  for (std::size_t f = 0; f < box.corners.size(); ++f)
    for (int a = 0; a < 4; ++a)
    {
      std::array<double, 4> weight{};
      weight[a] = 1.;
      const SmoothNormal n = box.normals.of_face(f, weight);
      EXPECT_NEAR(std::max({std::abs(n.direction[0]), std::abs(n.direction[1]),
                            std::abs(n.direction[2])}),
                  1., 1e-12);
      EXPECT_LT(n.spread, 1e-12);
      const Vec x = box.halo.position[box.corners[f][a]];
      int n_extreme = 0;
      for (int d = 0; d < 3; ++d)
        n_extreme += std::abs(x[d]) > 1.4e-3;
      EXPECT_NEAR(box.normals.of_node(box.corners[f][a]).spread,
                  2. * (1. - 1. / std::sqrt(n_extreme)), 1e-6);
    }
}

/** Two balls, the second turned about the axis of impact; velocity of the
    second after it. */
std::array<double, 3> rebound(const double cell, const bool b_bar)
{
  World world;
  for (const int side : {-1, 1})
  {
    FemOptions options;
    options.initial_velocity = {{0., 0., -side * 40.}};
    options.integration = b_bar ? "B-bar" : "one point";
    HexMesh mesh = make_sphere(4e-3, {{0., 0., 0.}}, cell);
    double low = 0.;
    for (const auto &p : mesh.nodes)
      low = std::min(low, p[2]);
    for (auto &p : mesh.nodes)
      p[2] += side * (1e-6 - low);
    world.bodies.push_back(std::make_unique<FemBody>(
        side < 0 ? "lower" : "upper", world.bodies.size(), mesh, elastic(),
        options));
  }
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  while (world.stepper.time() < 25e-6)
    world.advance(0.9);
  return world.bodies[1]->measure().velocity;
}

TEST(Contact, a_vertex_on_a_vertex_keeps_the_symmetry)
{
  for (const double cell : {1.6e-3, 1e-3})
    for (const bool b_bar : {false, true})
    {
      const auto v = rebound(cell, b_bar);
      EXPECT_NEAR(v[0], 0., 40. * 1e-9);
      EXPECT_NEAR(v[1], 0., 40. * 1e-9);
      if (b_bar)
      {
        EXPECT_GT(v[2], 0.95 * 40.);
      }
    }
}

/** An elastic ball of 4 mm falls at 50 m/s on the edges of a gap of 6 mm
   between two blocks. */
class BallOnGap
{
public:
  BallOnGap(const double cell)
  {
    for (const int side : {-1, 1})
      add(side < 0 ? "left" : "right",
          brick({{6 * h, 7 * h, 4 * h}}, {{side * 6. * h, 0., -2. * h}}, h),
          0.);
    add("ball", make_sphere(radius, {{0., 0., touching() + 0.6 * h}}, cell),
        -50.);
    std::vector<ContactPair> pairs;
    for (const int block : {0, 1})
    {
      pairs.push_back({block, 2, false});
      pairs.push_back({2, block, false});
    }
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    world.stepper.initialize();
  }
  static double touching() { return std::sqrt(radius * radius - 9. * h * h); }
  auto velocity(const int body) const
  {
    return world.bodies[body]->measure().velocity;
  }

  World world;

private:
  static constexpr double radius = 4 * h;
  void add(const char *const name, const HexMesh &mesh, const double velocity)
  {
    FemOptions options;
    options.initial_velocity = {{0., 0., velocity}};
    world.bodies.push_back(std::make_unique<FemBody>(name, world.bodies.size(),
                                                     mesh, elastic(), options));
  }
};

TEST(Contact, a_ball_on_a_gap_meets_its_edges_only_and_keeps_the_symmetry)
{
  for (const double cell : {h, 0.8 * h})
  {
    BallOnGap scene(cell);
    World &world = scene.world;
    while (!(std::abs(scene.velocity(0)[2]) > 1e-12))
    {
      ASSERT_LT(world.stepper.time(), 20e-6);
      world.advance(0.9);
    }
    // What bulges into the gap presses on nothing.
    EXPECT_NEAR(50. * world.stepper.time(), 0.6 * h, 0.3 * cell);
    const double end = world.stepper.time() + 5e-6;
    while (world.stepper.time() < end)
      world.advance(0.9);
    const auto left = scene.velocity(0), right = scene.velocity(1),
               ball = scene.velocity(2);
    EXPECT_GT(right[0], 0.1);
    EXPECT_NEAR(left[0] + right[0], 0., 50. * 1e-9);
    EXPECT_NEAR(left[2] - right[2], 0., 50. * 1e-9);
    EXPECT_NEAR(ball[0], 0., 50. * 1e-9);
  }
}
} // namespace
