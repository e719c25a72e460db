// Elastic, hardening and Johnson-Cook points against closed forms.
#include "point.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;
double G()
{
  return aluminum().shear_modulus();
}
double K()
{
  return aluminum().bulk_modulus();
}

JohnsonCookParameters johnson_cook()
{
  return johnson_cook_parameters("al6061-t6");
}

TEST(Elastic, uniaxial_strain)
{
  const Elastic law(aluminum());
  Point point(law);
  for (int n = 0; n < 10; ++n)
    point.step({1e-5, 0, 0, 0, 0, 0}, {0, 0, 0}, 1e-9);
  EXPECT_NEAR(point.stress[0], (K() + 4. / 3. * G()) * 1e-4, 1.);
  EXPECT_NEAR(point.stress[1], (K() - 2. / 3. * G()) * 1e-4, 1.);
  EXPECT_NEAR(point.energy, 0.5 * (K() + 4. / 3. * G()) * 1e-8, 1e-6);
}

TEST(Elastic, simple_shear_has_the_closed_form_of_the_jaumann_rate)
{
  // sigma_xy = G sin(gamma), sigma_xx = G (1 - cos(gamma)) (Dienes 1979).
  const Elastic law(aluminum());
  Point point(law);
  const int n = 4000;
  const double gamma = 3.;
  for (int i = 0; i < n; ++i)
    point.step({0, 0, 0, 0.5 * gamma / n, 0, 0}, {0.5 * gamma / n, 0, 0}, 1e-9);
  EXPECT_NEAR(point.stress[3], G() * std::sin(gamma), 1e-3 * G());
  EXPECT_NEAR(point.stress[0], G() * (1. - std::cos(gamma)), 1e-3 * G());
}

TEST(Elastic, rigid_rotation_turns_the_stress_only)
{
  const Elastic law(aluminum());
  Point point(law);
  point.step({1e-3, 0, 0, 0, 0, 0}, {0, 0, 0}, 1e-9);
  const double before = von_mises(point.stress);
  for (int i = 0; i < 100; ++i)
    point.step({0, 0, 0, 0, 0, 0}, {0.3, -0.1, 0.2}, 1e-9);
  EXPECT_NEAR(von_mises(point.stress), before, 1e-12 * before);
}

TEST(Laws, first_yield_is_where_they_say)
{
  EXPECT_FALSE(Elastic(aluminum()).initial_yield_stress());
  const HardeningPlasticity hardening(aluminum(),
                                      {aluminum_yield_stress(), 150e6, 0.5});
  const JohnsonCook johnson(aluminum(), johnson_cook());
  for (const Material *law : {static_cast<const Material *>(&hardening),
                              static_cast<const Material *>(&johnson)})
  {
    const double Y = law->initial_yield_stress().value();
    EXPECT_NEAR(Y, aluminum_yield_stress(), 0.001 * aluminum_yield_stress());
    // The last elastic and the first plastic of small steps bracket it.
    Point point(*law);
    const double step = 1e-6;
    while (point.theta == 1.)
    {
      EXPECT_LT(von_mises(point.stress), Y);
      point.step({0, 0, 0, step, 0, 0}, {0, 0, 0}, 1.);
    }
    EXPECT_NEAR(von_mises(point.stress), Y, 0.005 * Y);
  }
}

TEST(Hardening, shear_follows_the_closed_form)
{
  // Shear: sqrt(3) tau = Y + H eps, eps = (gamma - tau/G)/sqrt(3).
  for (const double isotropic : {1., 0., 0.5})
  {
    const HardeningPlasticity law(aluminum(),
                                  {aluminum_yield_stress(), 150e6, isotropic});
    Point point(law);
    const double gamma = 0.1;
    for (int i = 0; i < 500; ++i)
      point.step({0, 0, 0, 0.5 * gamma / 500, 0, 0}, {0, 0, 0}, 1e-9);
    const double Y = aluminum_yield_stress(), H = 150e6, root = std::sqrt(3.);
    const double tau = (Y + H * gamma / root) / (root + H / (root * G()));
    EXPECT_NEAR(point.stress[3], tau, 1e-9 * tau);
    EXPECT_NEAR(point.state[0], (gamma - tau / G()) / root, 1e-10);
  }
}

TEST(Hardening, kinematic_yields_early_on_reversal_and_isotropic_does_not)
{
  double reverse[2];
  for (const bool kinematic : {false, true})
  {
    const HardeningPlasticity law(
        aluminum(), {aluminum_yield_stress(), 2e9, kinematic ? 0. : 1.});
    Point point(law);
    for (int i = 0; i < 200; ++i)
      point.step({0, 0, 0, 2e-4, 0, 0}, {0, 0, 0}, 1e-9);
    const double top = point.stress[3], eps = point.state[0];
    while (point.state[0] == eps)
    {
      reverse[kinematic] = top - point.stress[3];
      point.step({0, 0, 0, -1e-6, 0, 0}, {0, 0, 0}, 1e-9);
    }
    // Elastic range: 2 tau_0 kinematic, 2 tau isotropic.
    const double expected =
        2. * (kinematic ? aluminum_yield_stress() / std::sqrt(3.) : top);
    EXPECT_NEAR(reverse[kinematic], expected, 4. * G() * 1e-6);
  }
}

TEST(JohnsonCook, shear_at_constant_rate_follows_the_integrated_law)
{
  const JohnsonCookParameters p = johnson_cook();
  const JohnsonCook law(aluminum(), p);
  Point point(law);
  const double rate = 1e4; // engineering shear rate [1/s]
  const double gamma = 0.6, dt = gamma / rate / 6000;
  for (int i = 0; i < 6000; ++i)
    point.step({0, 0, 0, 0.5 * gamma / 6000, 0, 0}, {0, 0, 0}, dt);
  // Independent integration by small explicit steps of
  // d tau/dt = G (rate - sqrt(3) d eps/dt) with yielding kept by bisection.
  double tau = 0., eps = 0., T = p.room_temperature;
  const int m = 60000;
  const double h = gamma / rate / m, root = std::sqrt(3.);
  for (int i = 0; i < m; ++i)
  {
    const double trial = tau + G() * rate * h;
    const auto yield = [&](const double d)
    {
      const double r = std::max(1., d / h / p.reference_strain_rate);
      return (p.A + p.B * std::pow(eps + d, p.n)) * (1. + p.C * std::log(r)) *
             (1. - std::pow(std::max(0., T - p.room_temperature) /
                                (p.melt_temperature - p.room_temperature),
                            p.m));
    };
    double low = 0., high = trial / (root * G());
    if (root * trial > yield(0.))
    {
      for (int k = 0; k < 60; ++k)
      {
        const double d = 0.5 * (low + high);
        (root * (trial - root * G() * d) > yield(d) ? low : high) = d;
      }
      tau = trial - root * G() * low;
      eps += low;
      T += p.taylor_quinney * root * tau * low /
           (aluminum().density * p.specific_heat);
    }
    else
      tau = trial;
  }
  EXPECT_NEAR(point.stress[3], tau, 2e-4 * tau);
  EXPECT_NEAR(point.state[0], eps, 2e-4 * eps);
  EXPECT_NEAR(point.state[1] - p.room_temperature, T - p.room_temperature,
              2e-3 * (T - p.room_temperature));
}

TEST(JohnsonCook, rate_is_clamped_below_the_reference)
{
  const JohnsonCook law(aluminum(), johnson_cook());
  double slope;
  EXPECT_DOUBLE_EQ(law.flow_stress(0.1, 1e-6, 1., 1., slope),
                   law.flow_stress(0.1, 1., 1., 1., slope));
  EXPECT_GT(law.flow_stress(0.1, 1e3, 1., 1., slope),
            law.flow_stress(0.1, 1., 1., 1., slope));
}

TEST(JohnsonCook, melt_has_no_strength_and_heating_can_be_off)
{
  JohnsonCookParameters p = johnson_cook();
  p.initial_temperature = 930.;
  const JohnsonCook melted(aluminum(), p);
  Point point(melted);
  point.step({0, 0, 0, 0.01, 0, 0}, {0, 0, 0}, 1e-6);
  EXPECT_NEAR(von_mises(point.stress), 0., 1.);
  p = johnson_cook();
  p.taylor_quinney = 0.;
  const JohnsonCook cold(aluminum(), p);
  Point other(cold);
  other.step({0, 0, 0, 0.05, 0, 0}, {0, 0, 0}, 1e-6);
  EXPECT_EQ(other.state[1], 294.);
  EXPECT_GT(other.state[0], 0.);
}

TEST(JohnsonCook, a_huge_step_still_lands_on_the_yield_surface)
{
  const JohnsonCook law(aluminum(), johnson_cook());
  Point point(law);
  point.step({1., -0.5, -0.5, 2., 1., 0.3}, {0, 0, 0}, 1e-8);
  double slope;
  const double yield =
      law.flow_stress(point.state[0], point.state[0] / 1e-8, 1., 1e-8, slope);
  EXPECT_NEAR(von_mises(point.stress), yield, 1e-6 * yield);
}

TEST(Energy, work_is_elastic_energy_and_plastic_work)
{
  const HardeningPlasticity law(aluminum(),
                                {aluminum_yield_stress(), 150e6, 1.});
  Point point(law);
  for (int i = 0; i < 2000; ++i)
    point.step({0, 0, 0, 2e-5, 0, 0}, {0, 0, 0}, 1e-9);
  const double tau = point.stress[3];
  EXPECT_NEAR(point.energy, 0.5 * tau * tau / G() + point.plastic_work,
              1e-3 * point.energy);
}
} // namespace
