// Material points: work of a step, states by name, points that are kept.
#include "sabot/bodies/material_points.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

TEST(MaterialPoints, work_is_the_trapezoidal_rule_with_viscous_pressure)
{
  MaterialPoints points(elastic());
  points.allocate(3, 8);
  PointStepArrays<8> arrays = {};
  PointStep step = arrays.views(1, 1, 1e-6);
  const double d = 1e-4, V = 2e-9, q = 3e5;
  arrays.strain[0][0] = d;
  arrays.jacobian[0] = 1. + d;
  arrays.half_volume[0] = 0.5 * V;
  arrays.viscous_pressure[0] = q;
  points.law().update(points.rotate(step));
  points.finish(step);
  // From rest: half of the final stress less half of q, along d.
  const double sigma = points.stress_row(0)[1];
  EXPECT_GT(sigma, 0.);
  EXPECT_NEAR(points.internal_energy[1], 0.5 * V * (sigma - q) * d,
              1e-12 * V * sigma * d);
  EXPECT_EQ(points.viscous_pressure[1], q);
  EXPECT_NEAR(points.total_stress(1)(0, 0), sigma - q, 1e-9 * sigma);
  // Nobody else has moved.
  EXPECT_EQ(points.stress_row(0)[0], 0.);
  EXPECT_EQ(points.internal_energy[2], 0.);
}

TEST(MaterialPoints, states_by_name_and_points_that_are_kept)
{
  MaterialPoints points(metal("al6061-t6"));
  points.allocate(6, 8);
  EXPECT_TRUE(points.has_state("temperature"));
  EXPECT_FALSE(points.has_state("humidity"));
  EXPECT_EQ(points.state("humidity"), nullptr);
  for (int i = 0; i < 6; ++i)
    points.state("temperature")[i] = 300. + i;
  points.keep({1, 2}, 2, 8); // points 2, 3, 4, 5
  ASSERT_EQ(points.size(), 4u);
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(points.state("temperature")[i], 302. + i);
  EXPECT_EQ(points.state("temperature")[7], 305.); // filled up
}
} // namespace
