// Every law in simple loadings against references that are integrated here,
// with steps much finer than the law's.
#include "point.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{
using namespace sabot;
const ElasticConstants &copper()
{
  return elastic_constants("copper-ofhc");
}

/** Flow stress as the test writes it: strain, rate [1/s], temperature. */
using FlowStress = std::function<double(double, double, double)>;

struct Shear
{
  double tau, eps, temperature;
};

/** Implicit Euler with bisection for shear at a constant rate: d tau = G (d
    gamma - sqrt(3) d eps), sqrt(3) tau = sigma(eps, rate, T). */
Shear integrate(const FlowStress &sigma, const double G, const double heating,
                const double T0, const double gamma, const double rate,
                const int n)
{
  Shear s{0., 0., T0};
  const double h = gamma / rate / n, root = std::sqrt(3.);
  for (int i = 0; i < n; ++i)
  {
    const double trial = s.tau + G * gamma / n;
    if (root * trial <= sigma(s.eps, 0., s.temperature))
    {
      s.tau = trial;
      continue;
    }
    double low = 0., high = trial / (root * G);
    for (int k = 0; k < 50; ++k)
    {
      const double d = 0.5 * (low + high);
      (root * (trial - root * G * d) > sigma(s.eps + d, d / h, s.temperature)
           ? low
           : high) = d;
    }
    s.tau = trial - root * G * low;
    s.eps += low;
    s.temperature += heating * root * s.tau * low;
  }
  return s;
}

/** The law's answer, states: strain, temperature. */
Shear drive(const Material &law, const double gamma, const double rate,
            const int n)
{
  Point point(law);
  for (int i = 0; i < n; ++i)
    point.step({0, 0, 0, 0.5 * gamma / n, 0, 0}, {0, 0, 0}, gamma / rate / n);
  return {point.stress[3], point.state[0], point.state[1]};
}

void expect_equal(const Shear &got, const Shear &expected, const double T0)
{
  EXPECT_NEAR(got.tau, expected.tau, 1e-3 * expected.tau);
  EXPECT_NEAR(got.eps, expected.eps, 1e-3 * expected.eps);
  EXPECT_NEAR(got.temperature - T0, expected.temperature - T0,
              3e-3 * (expected.temperature - T0));
}

TEST(OneElement, johnson_cook)
{
  const JohnsonCookParameters p = johnson_cook_parameters("copper-ofhc");
  const double T0 = p.room_temperature;
  const JohnsonCook law(copper(), p);
  for (const double rate : {1e-2, 1e3, 1e6})
    expect_equal(
        drive(law, 1., rate, 2000),
        integrate(
            [&](const double e, const double r, const double T)
            {
              return (p.A + p.B * std::pow(e, p.n)) *
                     (1. + p.C * std::log(std::max(1., r))) *
                     (1. - std::pow((T - T0) / (p.melt_temperature - T0), p.m));
            },
            copper().shear_modulus(),
            p.taylor_quinney / (copper().density * p.specific_heat), T0, 1.,
            rate, 20000),
        T0);
}

TEST(OneElement, zerilli_armstrong_fcc)
{
  ZerilliArmstrongParameters p;
  p.C0 = 65e6;
  p.C2 = 890e6;
  p.C3 = 0.0028;
  p.C4 = 0.000115;
  const ZerilliArmstrongFcc law(copper(), {p}, {294., 383., 0.9}, {});
  for (const double rate : {1e-2, 1e3, 1e6})
    expect_equal(drive(law, 1., rate, 2000),
                 integrate(
                     [](const double e, const double r, const double T)
                     {
                       return 65e6 + 890e6 * std::sqrt(e) *
                                         std::exp(-0.0028 * T) *
                                         std::pow(r, 0.000115 * T);
                     },
                     copper().shear_modulus(), 0.9 / (copper().density * 383.),
                     294., 1., rate, 20000),
                 294.);
}

TEST(OneElement, zerilli_armstrong_bcc)
{
  ZerilliArmstrongParameters p;
  p.is_bcc = true;
  p.C0 = 65e6;
  p.C1 = 1033e6;
  p.C3 = 0.00698;
  p.C4 = 0.000415;
  p.C5 = 266e6;
  p.n = 0.289;
  const ElasticConstants &iron = elastic_constants("iron-armco");
  const ZerilliArmstrongBcc law(iron, {p}, {294., 452., 0.9}, {});
  for (const double rate : {1e-2, 1e3, 1e6})
    expect_equal(drive(law, 1., rate, 2000),
                 integrate(
                     [](const double e, const double r, const double T)
                     {
                       return 65e6 +
                              1033e6 * std::exp(-0.00698 * T) *
                                  std::pow(r, 0.000415 * T) +
                              266e6 * std::pow(e, 0.289);
                     },
                     iron.shear_modulus(), 0.9 / (iron.density * 452.), 294.,
                     1., rate, 20000),
                 294.);
}

SteinbergGuinanParameters steinberg_aluminum()
{
  const auto entry = [](const std::string &e)
  { return metal_entry("al6061-t6-steinberg", "Steinberg-Guinan/" + e); };
  SteinbergGuinanParameters p;
  p.yield_stress = entry("Initial yield stress");
  p.largest_yield_stress = entry("Largest yield stress");
  p.beta = entry("Hardening coefficient");
  p.n = entry("Hardening exponent");
  p.pressure_coefficient = entry("Pressure coefficient");
  p.temperature_coefficient = entry("Temperature coefficient");
  p.melt_temperature = entry("Melt temperature");
  p.gruneisen = entry("Melt Gruneisen coefficient");
  p.melt_correction = entry("Melt volume correction");
  return p;
}

TEST(OneElement, steinberg_guinan_in_shear)
{
  // G falls with temperature: d tau = G(T)(d gamma - sqrt(3) d eps) and
  // sqrt(3) tau = Y(eps) G(T)/G0, so that d eps follows in closed form from
  // the derivative of the yield condition; Euler steps, explicit.
  const SteinbergGuinan law(aluminum(), {steinberg_aluminum()},
                            {300., 885., 0.9}, {});
  const Shear got = drive(law, 1., 1e5, 4000);
  const double G0 = aluminum().shear_modulus(), root = std::sqrt(3.);
  double tau = 0., eps = 0., T = 300.;
  const int n = 400000;
  for (int i = 0; i < n; ++i)
  {
    const double factor = 1. - 6.16e-4 * (T - 300.), G = G0 * factor;
    const double hardened = 0.29e9 * std::pow(1. + 125. * eps, 0.1);
    const double slope = hardened * 0.1 * 125. / (1. + 125. * eps);
    if (root * tau < hardened * factor)
    {
      tau += G / n;
      continue;
    }
    const double heating =
        0.9 * root * tau / (aluminum().density * 885.); // dT/d eps
    // root d tau = (slope factor - 6.16e-4 hardened heating) d eps
    const double d =
        root * G / n / (3. * G + slope * factor - 6.16e-4 * hardened * heating);
    tau += (slope * factor - 6.16e-4 * hardened * heating) * d / root;
    eps += d;
    T += heating * d;
  }
  expect_equal(got, {tau, eps, T}, 300.);
}

TEST(OneElement, steinberg_guinan_strengthens_with_pressure)
{
  // Pressure first, then shear far beyond yield: Y = Y0 (...) G(p, T)/G0.
  const SteinbergGuinan law(aluminum(), {steinberg_aluminum()},
                            {300., 885., 0.}, {});
  Point point(law);
  const double J = std::exp(-0.15);
  for (int i = 0; i < 100; ++i)
    point.step({-5e-4, -5e-4, -5e-4, 0, 0, 0}, {0, 0, 0}, 1e-9);
  for (int i = 0; i < 500; ++i)
    point.step({0, 0, 0, 1e-4, 0, 0}, {0, 0, 0}, 1e-9);
  const double pressure = aluminum().bulk_modulus() * 0.15;
  const double factor = 1. + 65.2e-12 * pressure * std::cbrt(J);
  EXPECT_NEAR(point.jacobian, J, 1e-8);
  const double yield =
      factor * 0.29e9 * std::pow(1. + 125. * point.state[0], 0.1);
  EXPECT_NEAR(von_mises(point.stress), yield, 1e-6 * yield);
  EXPECT_GT(factor, 1.5);
  EXPECT_NEAR(point.stiffening, factor, 1e-6);
  // Melting rises with compression.
  const SteinbergGuinanFlow flow{steinberg_aluminum()};
  EXPECT_DOUBLE_EQ(flow.melt_temperature(1.), 1220.);
  EXPECT_NEAR(flow.melt_temperature(J),
              1220. * std::exp(3. * (1. - J)) *
                  std::pow(1. / J, 2. * (1.97 - 1.5 - 1. / 3.)),
              1e-6);
}

TEST(OneElement, tabulated_hardening)
{
  // Uniaxial curve through (0, 100), (0.01, 200), (0.1, 300), then constant;
  // in shear sqrt(3) tau = Y(eps) for every share of kinematic hardening.
  for (const double isotropic : {1., 0.3, 0.})
  {
    HardeningParameters p;
    p.isotropic_fraction = isotropic;
    p.table_strain = {0., 0.01, 0.1};
    p.table_stress = {100e6, 200e6, 300e6};
    const HardeningPlasticity law(aluminum(), p);
    Point point(law);
    const auto table = [](const double e)
    {
      return e < 0.01  ? 100e6 + 1e10 * e
             : e < 0.1 ? 200e6 + 100e6 / 0.09 * (e - 0.01)
                       : 300e6;
    };
    int checked = 0;
    for (int i = 0; i < 400; ++i)
    {
      point.step({0, 0, 0, 5e-4, 0, 0}, {0, 0, 0}, 1e-9);
      if (point.state[0] > 0.)
      {
        ++checked;
        EXPECT_NEAR(std::sqrt(3.) * point.stress[3], table(point.state[0]), 1.);
      }
    }
    EXPECT_GT(checked, 300);
    // One step across all pieces.
    Point leap(law);
    leap.step({0, 0, 0, 0.2, 0, 0}, {0, 0, 0}, 1e-9);
    EXPECT_NEAR(std::sqrt(3.) * leap.stress[3], 300e6, 1.);
    // Elastic range on reversal: 2 Y isotropic, 2 Y(0) kinematic.
    const double top = point.stress[3], eps = point.state[0];
    double reverse = 0.;
    while (point.state[0] == eps)
    {
      reverse = top - point.stress[3];
      point.step({0, 0, 0, -1e-6, 0, 0}, {0, 0, 0}, 1e-9);
    }
    const double yield = 100e6 + isotropic * 200e6;
    EXPECT_NEAR(std::sqrt(3.) * reverse, 2. * yield,
                4. * aluminum().shear_modulus() * 1e-6);
  }
}

TEST(OneElement, neo_hookean)
{
  const NeoHookean law(aluminum());
  const double G = aluminum().shear_modulus(), K = aluminum().bulk_modulus();
  // Uniaxial strain to stretch 2: sigma_xx = 2/3 G J^(-5/3)(lambda^2 - 1) +
  // K ln J.
  Point point(law);
  for (int i = 0; i < 200; ++i)
    point.step({std::log(2.) / 200, 0, 0, 0, 0, 0}, {0, 0, 0}, 1e-9);
  const double l = point.F(0, 0);
  EXPECT_NEAR(l, 2., 1e-4);
  const double exact =
      2. / 3. * G * std::pow(l, -5. / 3.) * (l * l - 1.) + K * std::log(l);
  EXPECT_NEAR(point.stress[0], exact, 1e-9 * exact);
  // Simple shear: sigma_xy = G gamma, sigma_xx - sigma_yy = G gamma^2, and the
  // energy is G/2 gamma^2.
  Point shear(law);
  const int n = 4000;
  const double gamma = 2.;
  for (int i = 0; i < n; ++i)
    shear.step({0, 0, 0, 0.5 * gamma / n, 0, 0}, {0.5 * gamma / n, 0, 0}, 1e-9);
  EXPECT_NEAR(shear.F(0, 1), gamma, 1e-12);
  EXPECT_NEAR(shear.stress[3], G * gamma, 1e-9 * G);
  EXPECT_NEAR(shear.stress[0] - shear.stress[1], G * gamma * gamma, 1e-9 * G);
  EXPECT_NEAR(shear.energy, 0.5 * G * gamma * gamma, 1e-3 * G);
  EXPECT_GE(shear.stiffening, 0.5 * (2. + gamma * gamma));
  // A closed cycle gives the energy back.
  for (int i = 0; i < n; ++i)
    shear.step({0, 0, 0, -0.5 * gamma / n, 0, 0}, {-0.5 * gamma / n, 0, 0},
               1e-9);
  EXPECT_NEAR(von_mises(shear.stress), 0., 1e-9 * G);
  EXPECT_NEAR(shear.energy, 0., 1e-3 * G);
}

TEST(OneElement, johnson_cook_damage)
{
  JohnsonCookParameters p = johnson_cook_parameters("steel-4340");
  p.taylor_quinney = 0.;
  const ElasticConstants &steel = elastic_constants("steel-4340");
  EXPECT_EQ(JohnsonCook(steel, p).state_variables().size(), 2u);
  p.has_damage = true;
  const double T0 = p.room_temperature, *const D = p.D;
  const JohnsonCook law(steel, p);
  EXPECT_EQ(law.state_variables().back().name, "damage");
  // Pure shear, sigma* = 0, at 1000/s: damage is eps over a constant.
  Point point(law);
  const double rate = 1e3, gamma = 1.;
  for (int i = 0; i < 2000; ++i)
    point.step({0, 0, 0, 0.5 * gamma / 2000, 0, 0}, {0, 0, 0},
               gamma / rate / 2000);
  const double plastic_rate = rate / std::sqrt(3.);
  const double fracture = (D[0] + D[1]) * (1. + D[3] * std::log(plastic_rate));
  EXPECT_NEAR(point.state[2], point.state[0] / fracture, 1e-3 * point.state[2]);
  // Uniaxial tension of the set at rest: eps_f = D1 + D2 exp(D3/3).
  EXPECT_NEAR(law.fracture_strain(1. / 3., 1., T0),
              D[0] + D[1] * std::exp(D[2] / 3.), 1e-12);
  // Known before a run: in shear, slow.
  EXPECT_NEAR(*law.slow_fracture_strain(0.), D[0] + D[1], 1e-12);
  // Hot: factor 1 + D5 T*.
  EXPECT_NEAR(law.fracture_strain(0., 1., 0.5 * (T0 + p.melt_temperature)),
              (D[0] + D[1]) * (1. + 0.5 * D[4]), 1e-9);
  // It goes on beyond 1; the floor holds where the formula turns negative.
  for (int i = 0; i < 2000; ++i)
    point.step({0, 0, 0, 0.5e-2, 0, 0}, {0, 0, 0}, 1e-5);
  EXPECT_GT(point.state[2], 2.);
  p.D[0] = -0.77;
  p.D[1] = 1.45;
  p.D[2] = -0.47;
  EXPECT_EQ(JohnsonCook(steel, p).fracture_strain(5., 1., 294.), 0.01);
}
} // namespace
