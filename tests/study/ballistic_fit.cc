// Ballistic curves from exact data.
#include "sabot/study/ballistic_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sabot
{
namespace
{
std::vector<double> curve(const std::vector<double> &impact, const double a,
                          const double p, const double limit)
{
  std::vector<double> residual;
  for (const double v : impact)
    residual.push_back(
        v > limit ? a * std::pow(std::pow(v, p) - std::pow(limit, p), 1. / p)
                  : 0.);
  return residual;
}

TEST(BallisticFit, recovers_exact_curves)
{
  const std::vector<double> impact = {150., 190., 200., 250., 300., 400., 450.};
  for (const double a : {0.7, 1.})
    for (const double p : {1.7, 2., 3.})
      for (const double limit : {100., 184.5, 240.})
      {
        const BallisticFit fit =
            fit_ballistic(impact, curve(impact, a, p, limit));
        ASSERT_TRUE(fit.exists);
        EXPECT_NEAR(fit.limit, limit, 1e-3 * limit);
        if (fit.n_perforating >= 4)
        {
          EXPECT_NEAR(fit.a, a, 1e-3);
          EXPECT_NEAR(fit.p, p, 1e-2);
        }
        EXPECT_NEAR(fit.residual(350.), curve({350.}, a, p, limit)[0], 0.5);
        EXPECT_EQ(fit.residual(0.5 * limit), 0.);
      }
}

TEST(BallisticFit, few_runs_fix_the_exponent)
{
  const BallisticFit two = fit_ballistic(
      {100., 200., 300.}, curve({100., 200., 300.}, 0.8, 2., 150.));
  ASSERT_TRUE(two.exists);
  EXPECT_EQ(two.n_perforating, 2u);
  EXPECT_EQ(two.p, 2.);
  EXPECT_NEAR(two.limit, 150., 0.1);
  EXPECT_FALSE(fit_ballistic({100., 200.}, {0., 120.}).exists);
  EXPECT_FALSE(fit_ballistic({}, {}).exists);
}
} // namespace
} // namespace sabot
