// The flow stress that friction asks materials for.
#include "sabot/bodies/flow_stress.h"

#include "sabot/materials/johnson_cook.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/steinberg_guinan.h"
#include "sabot/materials/zerilli_armstrong.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

/** Of one point, its states one after the other. */
double flow_stress(const Material &law, const std::vector<double> &states,
                   const double pressure = 0., const double jacobian = 1.)
{
  FlowStressProbe points(law);
  points.add(pressure, jacobian,
             [&](const std::size_t row) { return states[row]; });
  return points.flow_stress()[0];
}

TEST(FlowStress, linear_and_tabulated_hardening)
{
  const HardeningPlasticity linear(aluminum(), {300e6, 2e9, 1.});
  for (const double eps : {0., 1e-4, 0.1, 2.})
    EXPECT_NEAR(flow_stress(linear, {eps}), 300e6 + 2e9 * eps,
                1e-6 * (300e6 + 2e9 * eps));
  const HardeningPlasticity perfect(aluminum(), {300e6, 0., 1.});
  EXPECT_NEAR(flow_stress(perfect, {0.7}), 300e6, 1e-6 * 300e6);
  const HardeningPlasticity table(
      aluminum(), {0., 0., 1., {0., 0.1, 0.2}, {100e6, 100e6, 400e6}});
  EXPECT_NEAR(flow_stress(table, {0.05}), 100e6, 100.);
  EXPECT_NEAR(flow_stress(table, {0.15}), 250e6, 250.);
  EXPECT_NEAR(flow_stress(table, {5.}), 400e6, 400.);
}

TEST(FlowStress, of_kinematic_hardening_is_the_size_of_the_yield_surface)
{
  const std::vector<double> hardened = {0.1, 50e6, -20e6, -30e6, 9e6, 0., 4e6};
  const HardeningPlasticity kinematic(aluminum(), {300e6, 2e9, 0.}),
      mixed(aluminum(), {300e6, 2e9, 0.25});
  EXPECT_NEAR(flow_stress(kinematic, hardened), 300e6, 300.);
  EXPECT_NEAR(flow_stress(mixed, hardened), 350e6, 350.);
}

TEST(FlowStress, of_johnson_and_cook_with_strain_and_temperature)
{
  JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  p.C = 0.02; // without effect at rest
  const JohnsonCook law(aluminum(), p);
  for (const double eps : {0., 1e-9, 1e-6, 1e-3, 0.05, 1.5})
    for (const double T : {200., 294., 500., 900.})
    {
      const double heated =
          std::max(0., (T - p.room_temperature) /
                           (p.melt_temperature - p.room_temperature));
      const double exact =
          (p.A + p.B * std::pow(eps, p.n)) * (1. - std::pow(heated, p.m));
      // The law itself takes 1e-14 for no strain.
      EXPECT_NEAR(flow_stress(law, {eps, T}), exact, 2e-6 * exact)
          << eps << " " << T;
    }
  EXPECT_EQ(flow_stress(law, {0.3, 1000.}), 0.); // melted
}

TEST(FlowStress, depends_on_pressure_and_volume_where_the_law_does)
{
  SteinbergGuinanParameters p;
  p.yield_stress = 290e6;
  p.largest_yield_stress = 680e6;
  p.beta = 125.;
  p.n = 0.1;
  p.pressure_coefficient = 6.5e-11;
  p.temperature_coefficient = 6.2e-4;
  const SteinbergGuinan law(aluminum(), SteinbergGuinanFlow{p}, {}, {});
  const double pressure = 5e9, J = 0.94, eps = 0.2, T = 450.;
  const double exact =
      290e6 * std::pow(1. + 125. * eps, 0.1) *
      (1. + 6.5e-11 * pressure * std::cbrt(J) - 6.2e-4 * (T - 300.));
  EXPECT_NEAR(flow_stress(law, {eps, T}, pressure, J), exact, 1e-6 * exact);
}

TEST(FlowStress, of_a_law_that_never_yields)
{
  EXPECT_GT(flow_stress(Elastic(aluminum()), {}), 1e100);
  EXPECT_GT(flow_stress(NeoHookean(aluminum()), {}, 0., 0.9), 1e100);
}

TEST(FlowStress, of_many_points_at_once)
{
  const HardeningPlasticity law(aluminum(), {300e6, 2e9, 1.});
  FlowStressProbe points(law);
  for (int i = 0; i < 200; ++i)
    points.add(0., 1., [&](std::size_t) { return 1e-3 * i; });
  const std::vector<double> Y = points.flow_stress();
  ASSERT_EQ(Y.size(), 200u);
  for (int i = 0; i < 200; ++i)
    EXPECT_NEAR(Y[i], 300e6 + 2e6 * i, 1e-6 * Y[i]);
}
} // namespace
