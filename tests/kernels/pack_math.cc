// Logarithm, exponential and powers of packs against the standard library's.
#include "sabot/kernels/pack_math.h"

#include <gtest/gtest.h>

#include <random>

namespace
{
using namespace sabot;

/** Largest error of @p function over random arguments by @p draw, in units of
    the last place of the exact result. */
template <typename Draw, typename Function, typename Exact>
double error(Draw draw, const Function &function, const Exact &exact)
{
  std::mt19937_64 generator(1);
  double worst = 0.;
  for (int i = 0; i < 100000; ++i)
  {
    WidePack a;
    for (std::size_t lane = 0; lane < n_wide; ++lane)
      a[lane] = draw(generator);
    const WidePack result = function(a);
    for (std::size_t lane = 0; lane < n_wide; ++lane)
    {
      const long double right = exact(static_cast<long double>(a[lane]));
      const double rounded = std::abs(static_cast<double>(right));
      const double unit = std::nextafter(rounded, 1e308) - rounded;
      worst = std::max(
          worst, std::abs(static_cast<double>(result[lane] - right)) / unit);
    }
  }
  return worst;
}

std::uniform_real_distribution<double> between(const double a, const double b)
{
  return std::uniform_real_distribution<double>(a, b);
}
/** Numbers whose logarithms are spread evenly between @p a and @p b. */
auto magnitude(const double a, const double b)
{
  return [spread = between(a, b)](auto &generator) mutable
  { return std::exp(spread(generator)); };
}

TEST(PackMath, logarithm_to_an_ulp)
{
  const auto log = [](const WidePack a) { return pack_log(a); };
  const auto exact = [](const long double a) { return std::log(a); };
  EXPECT_LT(error(magnitude(-700., 700.), log, exact), 1.);
  EXPECT_LT(error(between(0.5, 2.), log, exact), 1.);
  // Volume ratios, about which the logarithm itself is small.
  EXPECT_LT(error(between(1. - 1e-6, 1. + 1e-6), log, exact), 1.);
}

TEST(PackMath, exponential_to_an_ulp)
{
  const auto exp = [](const WidePack a) { return pack_exp(a); };
  const auto exact = [](const long double a) { return std::exp(a); };
  for (const double range : {1e-3, 1., 30., 707.})
    EXPECT_LT(error(between(-range, range), exp, exact), 1.1);
}

TEST(PackMath, power_to_the_rounding_of_its_exponent)
{
  for (const double b : {0.01, 0.34, 1., 1.34, -5. / 3.})
    EXPECT_LT(error(
                  magnitude(-32., 3.),
                  [b](const WidePack a) { return pack_power(a, b); },
                  [b](const long double a)
                  { return std::pow(a, static_cast<long double>(b)); }),
              2. + 32. * std::abs(b));
}

TEST(PackMath, cube_root)
{
  std::mt19937_64 generator(2);
  auto of_volumes = magnitude(-80., 80.);
  auto of_ratios = between(0.5, 2.);
  for (int i = 0; i < 100000; ++i)
  {
    const Pack a = {of_volumes(generator), of_ratios(generator), 1., 0.},
               root = pack_cbrt(a);
    for (std::size_t lane = 0; lane < 2; ++lane)
      EXPECT_NEAR(root[lane], std::cbrt(a[lane]),
                  4. * 2.3e-16 * std::cbrt(a[lane]));
    EXPECT_EQ(root[2], 1.);
    EXPECT_EQ(root[3], 0.);
    // The same bits in a wide pack.
    WidePack wide = {};
    for (std::size_t lane = 0; lane < n_wide; ++lane)
      wide[lane] = a[lane % n_lanes];
    const WidePack wide_root = pack_cbrt(wide);
    for (std::size_t lane = 0; lane < n_wide; ++lane)
      EXPECT_EQ(wide_root[lane], root[lane % n_lanes]);
  }
}

TEST(PackMath, exact_values_and_what_is_no_number)
{
  EXPECT_EQ(pack_log(splat<WidePack>(1.))[0], 0.);
  EXPECT_EQ(pack_exp(WidePack{})[0], 1.);
  EXPECT_EQ(pack_power(splat<WidePack>(1.), 1.7)[0], 1.);
  EXPECT_TRUE(std::isnan(pack_log(splat<WidePack>(-1.))[0]));
  EXPECT_TRUE(std::isnan(pack_log(WidePack{})[0]));
  EXPECT_TRUE(std::isfinite(pack_exp(splat<WidePack>(1e4))[0]));
}

TEST(PackMath, lanes_do_not_see_each_other)
{
  std::mt19937_64 generator(3);
  auto spread = between(-20., 3.);
  for (int i = 0; i < 1000; ++i)
  {
    const double x = spread(generator);
    WidePack mixed;
    for (std::size_t lane = 0; lane < n_wide; ++lane)
      mixed[lane] = lane == i % n_wide ? x : spread(generator);
    EXPECT_EQ(pack_exp(mixed)[i % n_wide], pack_exp(splat<WidePack>(x))[0]);
    const double y = std::exp(x);
    mixed[i % n_wide] = y;
    EXPECT_EQ(pack_log(pack_max(mixed, splat<WidePack>(1e-9)))[i % n_wide],
              pack_log(splat<WidePack>(y))[0]);
  }
}
} // namespace
