// Vectors, tensors, packs and kernel functions.
#include "sabot/kernels/vec.h"
#include "sabot/kernels/closest_point.h"
#include "sabot/kernels/eigen.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/principal.h"
#include "sabot/kernels/stress_update.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

namespace
{
using namespace sabot;

Mat random_matrix(std::mt19937 &generator)
{
  std::uniform_real_distribution<double> uniform(-1., 1.);
  Mat a = Mat::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      a.set(i, j, a(i, j) + 0.4 * uniform(generator));
  return a;
}

TEST(Vec, inverse_and_determinant)
{
  std::mt19937 generator(1);
  for (int n = 0; n < 20; ++n)
  {
    const Mat a = random_matrix(generator);
    double det;
    const Mat one = a * inverse(a, det);
    EXPECT_NEAR(det, to_eigen(a).determinant(), 1e-14);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(one(i, j), i == j, 1e-13);
  }
}

TEST(Kernel, cubic_spline_is_smooth_and_ends)
{
  EXPECT_DOUBLE_EQ(cubic_spline(0.), 2. / 3.);
  EXPECT_NEAR(cubic_spline(0.5 - 1e-12), cubic_spline(0.5 + 1e-12), 1e-11);
  EXPECT_EQ(cubic_spline(1.), 0.);
  EXPECT_EQ(cubic_spline(1.7), 0.);
  for (double r = 0.; r < 1.2; r += 0.01)
  {
    const Pack four = cubic_spline(Pack{r, 0.5 * r, 1., 2. * r});
    EXPECT_NEAR(four[0], cubic_spline(r), 4e-16);
    EXPECT_NEAR(four[1], cubic_spline(0.5 * r), 4e-16);
    EXPECT_EQ(four[2], 0.);
    EXPECT_NEAR(four[3], cubic_spline(2. * r), 4e-16);
  }
}

TEST(Kernel, damped_inverse)
{
  const Mat full = {{vec(2, 0, 0), vec(0, 4, 0), vec(0, 0, 5)}};
  int damped;
  const Mat a = damped_inverse(full, 1., damped);
  EXPECT_EQ(damped, 0);
  EXPECT_NEAR(a(1, 1), 0.25, 1e-14);
  // Continuous at the threshold, zero for a lost direction.
  const Mat lost = {{vec(2, 0, 0), vec(0, 4, 0), vec(0, 0, 0)}};
  const Mat b = damped_inverse(lost, 1., damped);
  EXPECT_EQ(damped, 1);
  EXPECT_NEAR(b(2, 2), 0., 1e-14);
  const Mat edge = {{vec(1. - 1e-9, 0, 0), vec(0, 4, 0), vec(0, 0, 5)}};
  EXPECT_NEAR(damped_inverse(edge, 1., damped)(0, 0), 1., 1e-8);
}

TEST(Kernel, clamp_limits_stretch_and_keeps_rotation)
{
  const Vec axes = vec(2., 1., 1.);
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Mat R = {{vec(c, -s, 0), vec(s, c, 0), vec(0, 0, 1)}};
  const Mat A = {{vec(2, 0, 0), vec(0, 1, 0), vec(0, 0, 1)}};
  const Mat U = {{vec(5, 0, 0), vec(0, 1, 0), vec(0, 0, 0.1)}};
  const Mat H = clamp_kernel(R * U * A, axes, 0.5, 2.);
  const Mat expected =
      R * Mat{{vec(2, 0, 0), vec(0, 1, 0), vec(0, 0, 0.5)}} * A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(H(i, j), expected(i, j), 1e-12);
}

TEST(Rotation, quarter_turn_in_steps_is_exact)
{
  // The Cayley rotation of w has angle 2 atan(|axial| / 2): choose w so that
  // nine steps make 90 degrees about z.
  const double step = 2. * std::tan(0.5 * (M_PI / 2.) / 9.);
  double t[6] = {3., -1., 2., 0.5, 0.25, -0.75};
  double *const tensor[6] = {&t[0], &t[1], &t[2], &t[3], &t[4], &t[5]};
  const double xy = -step, zero = 0.;
  const double *const spin[3] = {&xy, &zero, &zero};
  for (int n = 0; n < 9; ++n)
    rotate_symmetric(1, spin, tensor);
  const double expected[6] = {-1., 3., 2., -0.5, -0.75, -0.25};
  for (int c = 0; c < 6; ++c)
    EXPECT_NEAR(t[c], expected[c], 1e-14);
}

TEST(ClosestPoint, gap_and_weights_on_a_face)
{
  const std::array<Vec, 4> square = {
      {vec(0, 0, 0), vec(1, 0, 0), vec(1, 1, 0), vec(0, 1, 0)}};
  const FaceProjection inside = project_on_face(vec(0.3, 0.4, -0.2), square);
  EXPECT_NEAR(inside.gap, -0.2, 1e-15);
  EXPECT_NEAR(inside.normal[2], 1., 1e-15);
  Vec foot = {};
  double sum = 0.;
  for (int a = 0; a < 4; ++a)
  {
    foot += inside.weight[a] * square[a];
    sum += inside.weight[a];
  }
  EXPECT_NEAR(sum, 1., 1e-15);
  EXPECT_NEAR(foot[0], 0.3, 1e-14);
  EXPECT_NEAR(foot[1], 0.4, 1e-14);
  // Beyond an edge the gap is the distance to the edge.
  const FaceProjection outside = project_on_face(vec(1.3, 0.5, 0.4), square);
  EXPECT_NEAR(outside.gap, 0.5, 1e-14);
}
} // namespace
