// How far two bodies may close in within a step.
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/box_buckets.h"
#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/closing_speed.h"
#include "sabot/couplings/contact.h"
#include "verification/world.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

/** The step [s] of a rigid block that touches a rigid plate at 10 m/s, held by
    contacts of these stability fractions. */
double step_with(const std::vector<double> &fractions)
{
  World world;
  for (const double z : {1e-3, -1e-3})
  {
    BoxSpecification box;
    box.size = {{8e-3, 8e-3, 2e-3}};
    box.center = {{0., 0., z}};
    box.cell_size = 1e-3;
    RigidOptions options;
    options.initial_velocity = {{0., 0., z > 0. ? -10. : 0.}};
    world.bodies.push_back(std::make_unique<RigidBody>(
        z > 0. ? "block" : "plate", world.bodies.size(), make_graded_box(box),
        elastic(), options));
  }
  for (const double fraction : fractions)
  {
    ContactOptions options;
    options.stability_fraction = fraction;
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), std::vector<ContactPair>{{0, 1, false}},
        options, MPI_COMM_WORLD));
  }
  auto *const limit =
      new ClosingLimit(world.pointers(), world.couplings, MPI_COMM_WORLD);
  world.couplings.emplace_back(limit);
  world.distribute();
  limit->add_forces(0.);
  return limit->stable_step().dt;
}

TEST(Closing, rigid_bodies_close_in_by_what_their_spring_stops)
{
  // A node of an eighth of a cell has to stop two blocks of 128 each:
  // c = sqrt(phi m M)/4, with 1/M of both.
  const double phi = 0.1, c = 0.25 * std::sqrt(phi * 0.125 * 2. / 128.);
  EXPECT_LT(c, 0.01);
  EXPECT_NEAR(step_with({phi}), c * 1e-3 / 10., 1e-6 * c * 1e-3 / 10.);
  // That of the contact, not of any; of two the softer one.
  EXPECT_NEAR(step_with({0.25 * phi}) / step_with({phi}), 0.5, 1e-12);
  EXPECT_EQ(step_with({phi, 0.25 * phi}), step_with({0.25 * phi}));
}

/** Of the first two of three blocks that fly along together, of which number
    @p cut is cut at @p symmetry_faces. */
double closing_speed_of_two(const std::vector<unsigned int> &symmetry_faces,
                            const std::size_t cut = 0)
{
  World world;
  for (const double x : {300., 100., 0.})
  {
    FemOptions options;
    options.initial_velocity = {{x, 10., -900.}};
    if (world.bodies.size() == cut)
      options.symmetry_boundary_ids = symmetry_faces;
    BoxSpecification box;
    box.size = {{1e-3, 1e-3, 1e-3}};
    box.cell_size = 1e-3;
    world.bodies.push_back(
        std::make_unique<FemBody>("block", world.bodies.size(),
                                  make_graded_box(box), elastic(), options));
  }
  world.distribute();
  const std::vector<std::pair<int, int>> pair = {{0, 1}};
  ClosingSpeed speed;
  speed.largest(world.pointers(), pair, MPI_COMM_WORLD);
  return speed.largest(world.pointers(), pair, MPI_COMM_WORLD);
}

TEST(Closing, speed_bounds_nodes_and_their_images)
{
  // What flies along costs nothing once it is known, but across a plane: there
  // the whole has an image that flies the other way.
  EXPECT_NEAR(closing_speed_of_two({}), 200., 1e-9);
  EXPECT_NEAR(closing_speed_of_two({0}), 400., 1e-9);
  EXPECT_NEAR(closing_speed_of_two({2}), 2. * std::hypot(100., 10.), 1e-9);
  // Planes of others are walls for these, too.
  EXPECT_NEAR(closing_speed_of_two({0}, 2), 400., 1e-9);
}

TEST(Closing, box_tells_its_distance)
{
  Box box;
  box.add(vec(0., 0., 0.));
  box.add(vec(1., 2., 3.));
  EXPECT_EQ(box.distance_square(vec(0.5, 1., 3.)), 0.);
  EXPECT_EQ(box.distance_square(vec(3., 1., -1.)), 5.);
}
} // namespace
