// The largest eigenvalue of tridiagonal matrices, whatever their units.
#include "sabot/kernels/tridiagonal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{
using namespace sabot;

TEST(Tridiagonal, largest_eigenvalue_of_a_chain_of_springs)
{
  // 2 and -1: 2 - 2 cos(k pi/(n + 1)).
  for (const double unit : {1e-12, 1e-3, 1., 189., 1e6, 1e15})
    for (const int n : {1, 2, 3, 30})
    {
      const std::vector<double> on(n, 2. * unit), off(n - 1, -unit);
      const double exact =
          (2. + 2. * std::cos(std::acos(-1.) / (n + 1))) * unit;
      EXPECT_NEAR(largest_eigenvalue(on, off), exact, 1e-14 * exact);
    }
  EXPECT_EQ(largest_eigenvalue({0., 0.}, {0.}), 0.);
}

/** Of a body of particles, by Lanczos. Eigen does not come to an end with some
    5 % of its multiples unless they are scaled, and does not sort those; the
    largest stands twice in it, as Lanczos does after many steps, but for the
    last digits. */
TEST(Tridiagonal, nothing_is_above_the_largest_eigenvalue_in_any_unit)
{
  const std::vector<double> diagonal = {
      4.0257777765884439, 78.269161846003442, 48.016384409553162,
      56.46874888835918,  109.64485596403125, 121.37763574116482,
      33.731433099478451, 56.478642916250323, 41.407987290525462,
      55.839742232800553, 56.298218894567746, 19.988456902221813,
      49.768741297919831, 43.674843182945551, 26.800110763412885,
      38.067754662187596, 63.7967362272543,   18.521888571730432,
      26.535102510509482, 18.337888381894697, 17.196806113161347,
      22.237241327598195, 123.00240435108702, 84.909497867348932,
      26.128344765700536, 22.13174881222043,  15.471571729524319,
      25.904514256659031, 23.987169704038646, 17.148525274698944};
  const std::vector<double> beside = {
      9.0793822136134459, 33.710494933623387, 24.470363085516649,
      40.631324351218211, 63.876036836427396, 31.92933296890504,
      18.842442399392546, 27.86030477047148,  19.163526427102759,
      35.967952881427323, 13.073407526469754, 15.619509976656179,
      26.114091193868532, 16.160000794717543, 13.871859151199981,
      30.682791687595675, 14.980168741968946, 10.944495663484968,
      11.733564624030562, 8.0624803990958718, 10.457124584181711,
      16.412096657846085, 81.593832530544859, 14.300302801861188,
      13.478915783294891, 8.3208583228183528, 9.7203403680200218,
      13.065670969904998, 10.082888954730684};
  for (int k = 1; k < 2000; ++k)
  {
    const double unit = 0.01 * k;
    std::vector<double> on, off;
    for (const double x : diagonal)
      on.push_back(unit * x);
    for (const double x : beside)
      off.push_back(unit * x);
    // By Sturm's count of signs.
    const auto n_above = [&](const double x)
    {
      double q = on[0] - x;
      int n = q > 0.;
      for (std::size_t i = 1; i < on.size(); ++i)
      {
        q = on[i] - x - off[i - 1] * off[i - 1] / q;
        n += q > 0.;
      }
      return n;
    };
    const double largest = largest_eigenvalue(on, off);
    EXPECT_EQ(n_above(largest * (1. + 1e-12)), 0) << unit;
    EXPECT_GE(n_above(largest * (1. - 1e-12)), 1) << unit;
  }
}
} // namespace
