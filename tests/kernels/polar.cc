// Polar decomposition and rotations.
#include "sabot/kernels/polar.h"
#include "sabot/kernels/stress_update.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

Mat rotation(const Vec axis, const double angle)
{
  const Vec n = (1. / norm(axis)) * axis;
  Mat R = std::cos(angle) * Mat::identity();
  add_outer(R, (1. - std::cos(angle)) * n, n);
  const double s = std::sin(angle);
  R.row[0] += s * vec(0., -n[2], n[1]);
  R.row[1] += s * vec(n[2], 0., -n[0]);
  R.row[2] += s * vec(-n[1], n[0], 0.);
  return R;
}

double distance(const Mat &a, const Mat &b)
{
  double d = 0.;
  for (int i = 0; i < 3; ++i)
    d += norm(a.row[i] - b.row[i]);
  return d;
}

TEST(Polar, rotation_is_found_whatever_the_stretch)
{
  const Mat U = {{vec(2., 0.3, 0.1), vec(0.3, 0.5, -0.2), vec(0.1, -0.2, 1.)}};
  for (const double angle : {0., 0.1, 1.5, 3.1})
    for (const double size : {1e-3, 1., 1e3})
    {
      const Mat R = rotation(vec(1., -2., 0.5), angle);
      EXPECT_LT(distance(rotation_of(R * (size * U)), R), 1e-13);
    }
}

TEST(Polar, the_spin_of_a_rotation_rotates_by_it)
{
  const Mat R = rotation(vec(0.3, 1., -0.7), 0.8);
  double spin[3];
  cayley_spin(R, spin);
  const Mat S = {{vec(3., 1., -2.), vec(1., -1., 0.5), vec(-2., 0.5, 4.)}};
  double t[6] = {3., -1., 4., 1., 0.5, -2.};
  const double *const w[3] = {&spin[0], &spin[1], &spin[2]};
  double *const views[6] = {&t[0], &t[1], &t[2], &t[3], &t[4], &t[5]};
  rotate_symmetric(1, w, views);
  const Mat expected = R * S * transpose(R);
  EXPECT_NEAR(t[0], expected(0, 0), 1e-13);
  EXPECT_NEAR(t[1], expected(1, 1), 1e-13);
  EXPECT_NEAR(t[2], expected(2, 2), 1e-13);
  EXPECT_NEAR(t[3], expected(0, 1), 1e-13);
  EXPECT_NEAR(t[4], expected(1, 2), 1e-13);
  EXPECT_NEAR(t[5], expected(0, 2), 1e-13);
}
} // namespace
