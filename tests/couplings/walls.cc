// Which planes of symmetry hold which bodies.
#include "sabot/couplings/symmetry_walls.h"
#include "verification/convert.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

/** Particles that are yet to come are held where their host is, cells split or
    not, and whichever side of the planes they are on. */
TEST(SymmetryWalls, hold_particles_that_are_yet_to_come)
{
  for (const double side : {1., -1.})
    for (const double spacing : {0., 0.5e-3})
    {
      World world;
      ConvertingOptions options;
      options.spacing = spacing;
      options.fem.symmetry_boundary_ids = {side > 0. ? 0u : 1u,
                                           side > 0. ? 2u : 3u};
      const auto mesh = block_mesh({{4e-3, 4e-3, 3e-3}},
                                   {{side * 2e-3, side * 2e-3, 0.}}, 1e-3);
      add_converting(world, mesh, hardening_aluminum(), options);
      world.bodies[0]->own_particles = world.bodies[1].get();
      const auto walls = find_symmetry_walls(world.pointers());
      for (const std::size_t body : {0u, 1u})
      {
        ASSERT_EQ(walls[body].size(), 2u);
        for (int axis = 0; axis < 2; ++axis)
        {
          EXPECT_EQ(walls[body][axis].plane.axis, axis);
          EXPECT_NEAR(walls[body][axis].plane.coordinate, 0., 1e-12);
          EXPECT_EQ(walls[body][axis].side, side);
          EXPECT_GE(walls[body][axis].held_within, 0.);
          EXPECT_LT(walls[body][axis].held_within, 1e-9);
        }
      }
    }
}
} // namespace
