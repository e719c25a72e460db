// Studies: their files, results, tables and charts.
#include "sabot/base/hash.h"
#include "sabot/simulation/zone_verdict.h"
#include "sabot/study/analysis.h"
#include "sabot/study/chart.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace sabot;

namespace
{
TEST(Analysis, power_law_gives_back_its_order_and_limit)
{
  for (const double p : {0.8, 1.5, 2.})
  {
    std::vector<double> h = {1.6, 1.0, 0.75, 0.5}, f;
    for (const double x : h)
      f.push_back(344. - 20. * std::pow(x, p));
    const Convergence fit = fit_convergence(h, f);
    ASSERT_TRUE(fit.has_order);
    EXPECT_NEAR(fit.order, p, 1e-5);
    EXPECT_NEAR(fit.limit, 344., 1e-4);
    // 1.25 times the distance of the finest value.
    EXPECT_NEAR(fit.uncertainty, 1.25 * 20. * std::pow(0.5, p), 1e-3);
    f.pop_back();
    h.pop_back();
    EXPECT_NEAR(fit_convergence(h, f).order, p, 1e-4); // three are enough
  }
}

TEST(Analysis, values_that_go_up_and_down_have_no_order)
{
  const Convergence fit =
      fit_convergence({1.6, 1.27, 1.0, 0.75}, {300., 340., 310., 345.});
  EXPECT_FALSE(fit.has_order);
  EXPECT_EQ(fit.limit, 345.);
  EXPECT_EQ(fit.uncertainty, 3. * 45.);
  EXPECT_FALSE(fit_convergence({2., 1., 0.5}, {1., 2., 1.}).has_order);
  EXPECT_FALSE(fit_convergence({2., 1.}, {1., 2.}).has_order);
}

TEST(Analysis, the_pareto_front_holds_what_nothing_beats)
{
  const double nan = std::nan("");
  const std::vector<double> cost = {10., 1., 5., 4., 20., 2., nan},
                            error = {1., 9., 3., 3., 1., nan, 0.};
  EXPECT_EQ(pareto_front(cost, error), (std::vector<std::size_t>{1, 3, 0}));
}

TEST(Analysis, prices_come_from_pairs_that_differ_in_one_thing)
{
  // Two parameters with 2 and 2 values, a grid with one run missing.
  const std::vector<PricedRun> runs = {
      {{0, 0}, 100., 5.}, {{1, 0}, 60., 5.5}, {{0, 1}, 80., 6.}};
  const std::vector<Price> prices = price_list(runs, {2, 2});
  ASSERT_EQ(prices.size(), 2u);
  EXPECT_EQ(prices[0].parameter, 0u);
  EXPECT_EQ(prices[0].n_pairs, 1u);
  EXPECT_DOUBLE_EQ(prices[0].seconds_saved, 40.);
  EXPECT_DOUBLE_EQ(prices[0].quantity_change, 0.5);
  EXPECT_DOUBLE_EQ(prices[1].seconds_saved, 20.);
  EXPECT_DOUBLE_EQ(prices[1].quantity_change, 1.);
}

TEST(Charts, ticks_are_round_and_inside)
{
  EXPECT_EQ(axis_ticks(0., 10., 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  for (const double t : axis_ticks(-0.013, 0.021, 5))
    EXPECT_TRUE(t >= -0.013 && t <= 0.021);
  EXPECT_EQ(escape_html("a<b & 'c'"), "a&lt;b &amp; &#39;c&#39;");
}

TEST(Hash, of_known_texts)
{
  // FIPS 180-4 examples.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223"
                           "b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb924"
                        "27ae41e4649b934ca495991b7852b855");
}

TEST(Base64, of_known_texts)
{
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Zone, distance_from_the_tie_counts_tied_faces_only)
{
  ZoneBox zone;
  zone.low = {{-5., -5., -2.}};
  zone.high = {{5., 5., 0.}};
  zone.spacing = {{1., 0.5, 0.1}};
  zone.tied_low = {{true, true, false}};
  zone.tied_high = {{true, true, false}};
  EXPECT_DOUBLE_EQ(zone.distance_from_tie({{0., 0., 0.}}), 5.);
  EXPECT_DOUBLE_EQ(zone.distance_from_tie({{0., 4.5, -2.}}), 1.);
  EXPECT_DOUBLE_EQ(zone.distance_from_tie({{4.5, 0., -1.}}), 0.5);
  EXPECT_DOUBLE_EQ(zone.distance_from_tie({{7., 0., -1.}}), -2.);
}
} // namespace
