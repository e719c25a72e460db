// Principal values of symmetric tensors, and smooth pressure on a patch.
#include "sabot/kernels/principal.h"
#include "sabot/kernels/patch_weights.h"
#include "sabot/kernels/symmetric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
using namespace sabot;

TEST(Principal, tension_is_cut_and_compression_stays)
{
  // Principal values 3 and -1 in the plane x, y, and -2.
  double s[6] = {1., 1., -2., 2., 0., 0.};
  EXPECT_NEAR(largest_principal(s), 3., 1e-14);
  cut_tension(s);
  const double expected[6] = {-0.5, -0.5, -2., 0.5, 0., 0.};
  for (int c = 0; c < 6; ++c)
    EXPECT_NEAR(s[c], expected[c], 1e-14);
  EXPECT_NEAR(largest_principal(s), 0., 1e-14);
  double compressed[6] = {-3., -2., -1., 0.1, 0.2, 0.3};
  const double before = compressed[3];
  cut_tension(compressed);
  EXPECT_EQ(compressed[3], before);
}

TEST(Principal, the_largest_eigenvalue_is_bounded_closely)
{
  std::mt19937 random(1);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 3000; ++trial)
  {
    // Positive semidefinite of rank 1, 2 or 3, of any size; also two or three
    // equal eigenvalues.
    const double size = std::pow(10., 12. * number(random));
    double s[6] = {};
    for (int k = 0; k < trial % 4; ++k)
    {
      const Vec v = vec(number(random), number(random), number(random));
      for (int c = 0; c < 3; ++c)
      {
        s[c] += size * v[c] * v[c];
        s[3 + c] += size * v[c == 1 ? 1 : 0] * v[c == 0 ? 1 : 2];
      }
    }
    if (trial % 4 == 0)
      for (int c = 0; c < 3; ++c)
        s[c] = c < 2 || trial % 8 == 0 ? size : 0.1 * size;
    Pack four[6];
    for (int c = 0; c < 6; ++c)
      four[c] = Pack{1., 0., s[c], 2. * (c < 3)};
    const Pack bounds = largest_eigenvalue_bound(four);
    EXPECT_EQ(bounds[1], 0.);
    EXPECT_NEAR(bounds[3], 2., 1e-12);
    const double largest = largest_principal(s), bound = bounds[2];
    EXPECT_GE(bound, (1. - 1e-12) * largest);
    EXPECT_LE(bound, 1.03 * largest);
  }
}

TEST(Principal, the_middle_eigenvalue)
{
  const Mat m = {{vec(5, 0, 0), vec(0, 2, 1), vec(0, 1, 2)}};
  EXPECT_NEAR(middle_eigenvalue(m), 3., 1e-14);
}

TEST(Principal, eigenvalues_above_a_limit)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1., 1.);
  for (int trial = 0; trial < 2000; ++trial)
  {
    const double a = number(random), b = number(random), c = number(random),
                 d = number(random), e = number(random), f = number(random);
    const Mat m = {{vec(a, d, f), vec(d, b, e), vec(f, e, c)}};
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(to_eigen(m))
            .eigenvalues()[0];
    EXPECT_TRUE(has_eigenvalues_above(m, least - 1e-12));
    EXPECT_FALSE(has_eigenvalues_above(m, least + 1e-12));
    // Both ways of the damped inverse agree where nothing is damped.
    const Mat moment = m * transpose(m) + 0.5 * Mat::identity();
    int n_damped = 1;
    const Mat unit = damped_inverse(moment, 0.4, n_damped) * moment;
    EXPECT_EQ(n_damped, 0);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(norm(unit.row[i] - Mat::identity().row[i]), 0., 1e-13);
  }
  Mat hole = Mat::identity();
  hole.set(2, 1, std::nan(""));
  EXPECT_FALSE(has_eigenvalues_above(hole, 0.));
}

TEST(PatchWeights, add_to_one_without_a_moment)
{
  std::vector<Vec> point;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      point.push_back(vec(i, j, 0.));
  const std::vector<double> area(point.size(), 1.);
  std::vector<double> weight;
  const Vec center = vec(0.2, -0.3, 0.1);
  ASSERT_TRUE(patch_weights(point, area, center, vec(0., 0., 1.), 2., weight));
  double sum = 0.;
  Vec moment = {};
  for (std::size_t a = 0; a < point.size(); ++a)
  {
    sum += weight[a];
    moment += weight[a] * (point[a] - center);
  }
  EXPECT_NEAR(sum, 1., 1e-13);
  EXPECT_NEAR(moment[0], 0., 1e-13);
  EXPECT_NEAR(moment[1], 0., 1e-13);
  // Two nodes do not span a surface.
  EXPECT_FALSE(patch_weights({point[12], point[13]}, {1., 1.}, point[12],
                             vec(0., 0., 1.), 2., weight));
}
} // namespace
