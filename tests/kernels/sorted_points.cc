// Points by cubes: all that are near, and no others.
#include "sabot/kernels/sorted_points.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace
{
using namespace sabot;

/** For each point that @p wanted says, those that are found near it; empty for
    the others. Each once. */
template <typename Wanted>
std::vector<std::set<std::uint32_t>> found_near(const std::vector<Vec> &points,
                                                const double reach,
                                                const Wanted &wanted)
{
  std::vector<std::set<std::uint32_t>> found(points.size());
  SortedPoints(
      points.size(), [&](const std::size_t k) { return points[k]; }, reach)
      .for_each(wanted,
                [&](const std::uint32_t k, const std::uint32_t *const near,
                    const std::size_t n)
                {
                  EXPECT_TRUE(found[k].empty());
                  found[k] = {near, near + n};
                  EXPECT_EQ(found[k].size(), n);
                });
  return found;
}

TEST(SortedPoints, all_that_are_near_come_once)
{
  std::mt19937 random(3);
  for (const double size : {0.5, 3., 40.}) // over the reach
    for (const std::size_t n : {1, 2, 7, 300})
    {
      const double reach = 0.7e-3;
      std::uniform_real_distribution<double> place(-size * reach, size * reach);
      std::vector<Vec> points;
      for (std::size_t k = 0; k < n; ++k)
        points.push_back(vec(place(random), place(random), place(random)));
      points.push_back(vec(1., 0., 0.)); // farther than a thousand cubes
      const auto is_asked = [](const std::uint32_t k) { return k % 3 != 1; };
      const auto found = found_near(points, reach, is_asked);
      for (std::size_t k = 0; k <= n; ++k)
      {
        std::set<std::uint32_t> near;
        for (std::size_t m = 0; m <= n && is_asked(k); ++m)
          if (norm(points[m] - points[k]) < reach)
            near.insert(m);
        EXPECT_EQ(found[k], near) << size << ", " << n << ": " << k;
      }
    }
}

TEST(SortedPoints, what_is_beyond_a_million_cubes_is_found)
{
  const std::vector<Vec> points = {vec(0., 0., 0.), vec(5e6, 0., 0.),
                                   vec(8e6, 0., 0.), vec(8e6 + 0.5, 0., 0.)};
  const auto found = found_near(points, 1., [](std::uint32_t) { return true; });
  const std::vector<std::set<std::uint32_t>> expected = {
      {0}, {1}, {2, 3}, {2, 3}};
  EXPECT_EQ(found, expected);
}

TEST(SortedPoints, nothing_is_found_among_none)
{
  EXPECT_TRUE(found_near({}, 1., [](std::uint32_t) { return true; }).empty());
}
} // namespace
