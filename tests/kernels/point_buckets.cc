// Points in cubes: all near ones are found, in the order in which they came.
#include "sabot/kernels/point_buckets.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace
{
using namespace sabot;

TEST(PointBuckets, all_that_are_near_come_once_and_those_of_a_cube_in_order)
{
  std::mt19937 generator(2);
  for (const double size : {0.5, 3., 40.}) // of the cloud, over the reach
  {
    constexpr double reach = 0.7;
    std::uniform_real_distribution<double> uniform(-size * reach, size * reach);
    PointBuckets buckets(reach);
    std::vector<Vec> points;
    const auto check = [&]()
    {
      for (const Vec x : points)
      {
        std::vector<std::size_t> found;
        buckets.for_near(x, [&](const std::size_t k) { found.push_back(k); });
        const std::set<std::size_t> once(found.begin(), found.end());
        EXPECT_EQ(once.size(), found.size());
        for (std::size_t k = 0; k < points.size(); ++k)
          if (norm(points[k] - x) <= reach)
          {
            EXPECT_EQ(once.count(k), 1u);
          }
        for (std::size_t n = 1; n < found.size(); ++n)
        {
          const auto cube = [&](const std::size_t k)
          {
            std::array<double, 3> c;
            for (int d = 0; d < 3; ++d)
              c[d] = std::floor(points[k][d] / reach);
            return c;
          };
          if (cube(found[n]) == cube(found[n - 1]))
          {
            EXPECT_LT(found[n - 1], found[n]);
          }
        }
      }
    };
    check();
    // More may be added after a look.
    for (const int more : {1, 200, 100})
    {
      for (int i = 0; i < more; ++i)
      {
        points.push_back(
            vec(uniform(generator), uniform(generator), uniform(generator)));
        buckets.add(points.back(), points.size() - 1);
      }
      check();
    }
  }
}

TEST(PointBuckets, nothing_is_found_among_none)
{
  PointBuckets buckets(1.);
  buckets.for_near(vec(0., 0., 0.), [](const std::size_t) { FAIL(); });
}
} // namespace
