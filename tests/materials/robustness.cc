// Melt, rates from 1e-3 to 1e7 1/s, extreme strain: numbers stay numbers, the
// yield stress is never negative and never exceeded.
#include "point.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

struct Case
{
  std::string name;
  std::shared_ptr<Material> law;
  double strongest; // bound of the von Mises stress at 1e7/s [Pa]
};

std::vector<Case> laws(const double temperature)
{
  JohnsonCookParameters jc = johnson_cook_parameters("al6061-t6");
  jc.initial_temperature = temperature;
  jc.has_damage = true;
  ZerilliArmstrongParameters fcc;
  fcc.C0 = 65e6;
  fcc.C2 = 890e6;
  fcc.C3 = 0.0028;
  fcc.C4 = 0.000115;
  fcc.melt_temperature = 925.;
  ZerilliArmstrongParameters bcc = fcc;
  bcc.is_bcc = true;
  bcc.C1 = 1033e6;
  bcc.C5 = 266e6;
  bcc.n = 0.289;
  bcc.C3 = 0.00698;
  bcc.C4 = 0.000415;
  SteinbergGuinanParameters sg;
  sg.yield_stress = 0.29e9;
  sg.largest_yield_stress = 0.68e9;
  sg.beta = 125.;
  sg.n = 0.1;
  sg.pressure_coefficient = 65.2e-12;
  sg.temperature_coefficient = 6.16e-4;
  sg.melt_temperature = 1220.;
  const ThermalParameters thermal{temperature, jc.specific_heat, 0.9};
  std::vector<Case> cases;
  for (const bool gruneisen : {false, true})
  {
    std::shared_ptr<const EquationOfState> eos;
    if (gruneisen)
      eos = std::make_shared<MieGruneisen>(
          mie_gruneisen_parameters("al6061-t6-eos"));
    const std::string with = gruneisen ? " + Mie-Gruneisen" : "";
    cases.push_back(
        {"hardening" + with,
         std::make_shared<HardeningPlasticity>(
             aluminum(),
             HardeningParameters{aluminum_yield_stress(), 150e6, 0.5}, eos),
         1e10});
    cases.push_back({"johnson-cook" + with,
                     std::make_shared<JohnsonCook>(aluminum(), jc, eos), 5e9});
    cases.push_back(
        {"fcc" + with,
         std::make_shared<ZerilliArmstrongFcc>(
             aluminum(), ZerilliArmstrongFlow<false>{fcc}, thermal, eos),
         2e10});
    cases.push_back(
        {"bcc" + with,
         std::make_shared<ZerilliArmstrongBcc>(
             aluminum(), ZerilliArmstrongFlow<true>{bcc}, thermal, eos),
         2e10});
    cases.push_back({"steinberg" + with,
                     std::make_shared<SteinbergGuinan>(
                         aluminum(), SteinbergGuinanFlow{sg}, thermal, eos),
                     0.});
    cases.push_back(
        {"elastic" + with, std::make_shared<Elastic>(aluminum(), eos), 0.});
    cases.push_back({"neo-hookean" + with,
                     std::make_shared<NeoHookean>(aluminum(), eos), 0.});
  }
  return cases;
}

bool finite(const Point &point)
{
  bool ok = true;
  for (const double s : point.stress)
    ok = ok && std::isfinite(s);
  for (const double s : point.state)
    ok = ok && std::isfinite(s);
  return ok && std::isfinite(point.theta) && std::isfinite(point.work) &&
         std::isfinite(point.stiffening);
}

TEST(Robustness, rates_temperatures_and_strains)
{
  for (const double temperature : {0., 77., 294., 924.9, 925., 1219., 5000.})
    for (const Case &c : laws(temperature))
      for (const double rate : {1e-3, 1., 1e3, 1e7})
        for (const double part : {1e-6, 1e-2, 0.5})
        {
          Point point(*c.law);
          for (int i = 0; i < 100; ++i)
          {
            const double e = i / 5 % 2 == 0 ? part : -part;
            point.step({e, -0.4 * e, -0.5 * e, e, -0.3 * e, 0.2 * e},
                       {0.1 * e, 0., 0.}, part / rate);
            ASSERT_TRUE(finite(point)) << c.name << " T " << temperature
                                       << " rate " << rate << " step " << part;
            ASSERT_GE(point.theta, 0.) << c.name;
            ASSERT_LE(point.theta, 1.) << c.name;
            ASSERT_GE(point.work, 0.) << c.name;
            if (c.strongest > 0.)
            {
              ASSERT_LT(von_mises(point.stress), c.strongest) << c.name;
            }
            if (temperature >= 925. && c.strongest > 0. &&
                c.name.find("hardening") == std::string::npos)
            {
              ASSERT_NEAR(von_mises(point.stress), 0., 1e-3) << c.name;
            }
          }
        }
}

TEST(Robustness, a_step_without_strain_changes_nothing)
{
  for (const Case &c : laws(294.))
  {
    Point point(*c.law);
    for (int i = 0; i < 3; ++i)
      point.step({0, 0, 0, 0, 0, 0}, {0, 0, 0}, 1e-9);
    ASSERT_TRUE(finite(point)) << c.name;
    EXPECT_EQ(von_mises(point.stress), 0.) << c.name;
    EXPECT_EQ(point.theta, 1.) << c.name;
  }
}

TEST(Robustness, heating_stops_at_melt)
{
  for (const Case &c : laws(294.))
  {
    if (c.law->state_variables().size() < 2)
      continue;
    std::size_t t = 0;
    const auto variables = c.law->state_variables();
    while (t < variables.size() && variables[t].name != "temperature")
      ++t;
    if (t == variables.size())
      continue;
    Point point(*c.law);
    for (int i = 0; i < 20000; ++i)
      point.step({0, 0, 0, i / 20 % 2 == 0 ? 0.01 : -0.01, 0, 0}, {0, 0, 0},
                 1e-6);
    ASSERT_TRUE(finite(point)) << c.name;
    EXPECT_LT(point.state[t], 1300.) << c.name;
    EXPECT_GT(point.state[t], 600.) << c.name;
  }
}
} // namespace
