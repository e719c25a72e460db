// Choices of SPG bodies by name, critical values, what failed metal carries.
#include "sabot/base/choice.h"
#include "sabot/bodies/spg/spg_options.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

template <typename Product>
std::vector<std::string> names()
{
  std::vector<std::string> all;
  for (const auto &entry : Registry<Product>::entries())
    all.push_back(entry.name);
  return all;
}

TEST(SpgRooms, choices_are_registered)
{
  using Names = std::vector<std::string>;
  EXPECT_EQ(names<Stabilization>(),
            (Names{"bond residual", "none", "second gradient",
                   "velocity smoothing"}));
  EXPECT_EQ(names<FailureCriterion>(),
            (Names{"damage", "effective plastic strain",
                   "maximum principal stress", "maximum shear strain"}));
  EXPECT_EQ(names<ResidualStrength>(),
            (Names{"compression", "everything", "friction"}));
}

SpgOptions
parse(const std::vector<std::pair<std::string, std::string>> &entries)
{
  Parameters prm;
  SpgOptions::declare_parameters(prm);
  for (const auto &entry : entries)
    EXPECT_TRUE(prm.set(entry.first, entry.second)) << entry.first;
  return SpgOptions::parse(prm, "Bodies/core");
}

TEST(SpgRooms, never_is_a_word_and_so_are_the_numbers_of_older_files)
{
  const std::string strain = "Critical effective plastic strain";
  EXPECT_FALSE(parse({}).can_fail());
  EXPECT_FALSE(parse({{strain, "never"}}).can_fail());
  EXPECT_FALSE(parse({{strain, "1e10"}}).can_fail());
  const SpgOptions fails = parse({{strain, "0.4"}});
  ASSERT_TRUE(fails.can_fail());
  EXPECT_EQ(fails.failure_criterion->critical_value(), 0.4);
  const std::pair<std::string, std::string> by_stress{
      "Failure criterion", "maximum principal stress"};
  EXPECT_FALSE(
      parse({by_stress, {"Critical principal stress", "1e15"}}).can_fail());
  EXPECT_EQ(parse({by_stress, {"Critical principal stress", "2 GPa"}})
                .failure_criterion->critical_value(),
            2e9);
}

TEST(SpgRooms, entries_without_effect_are_refused)
{
  EXPECT_THROW(parse({{"Critical shear strain", "0.2"}}), InputError);
  EXPECT_THROW(parse({{"Smoothing coefficient", "0.2"}}), InputError);
  EXPECT_THROW(parse({{"Stabilization", "second gradient"}}), InputError);
  EXPECT_NO_THROW(parse({{"Critical shear strain", "1e10"}}));
}

/** One point under a rule for failed metal, strained in one step. */
struct FailedPoint
{
  double strain[6][1] = {}, stress[6][1] = {}, jacobian[1] = {1.},
         extra[1] = {}, theta[1], work[1], half_volume[1] = {0.5e-9},
         loss[1] = {}, friction[1] = {};
  std::vector<double> state;

  /** @p strain has been set. */
  void update(ResidualStrength &rule, const Material &law)
  {
    MaterialBatch batch;
    batch.n = 1;
    batch.dt = 1e-6;
    for (int c = 0; c < 6; ++c)
    {
      batch.strain_increment[c] = strain[c];
      batch.stress[c] = stress[c];
    }
    state.clear();
    for (const StateVariable &variable : law.state_variables())
      state.insert(state.end(), variable.is_tensor ? 6 : 1,
                   variable.initial_value);
    std::vector<double *> rows;
    for (double &value : state)
      rows.push_back(&value);
    jacobian[0] = std::exp(strain[0][0] + strain[1][0] + strain[2][0]);
    batch.jacobian = jacobian;
    batch.states = rows.data();
    batch.extra_square = extra;
    batch.return_factor = theta;
    batch.plastic_work = work;
    const char is_failed[1] = {1};
    rule.update(law, batch, {is_failed, half_volume, loss, friction});
  }
};

TEST(SpgRooms, what_failed_metal_carries)
{
  // One point in uniaxial tension: all of it, or none across the crack.
  const auto law = elastic();
  for (const std::string rule : {"everything", "compression", "friction"})
  {
    FailedPoint point;
    point.strain[0][0] = 1e-4;
    point.update(*choose<ResidualStrength>(rule)(), *law);
    const double full =
        1e-4 * (law->bulk_modulus() + 4. / 3. * law->shear_modulus());
    EXPECT_NEAR(point.stress[0][0], rule == "everything" ? full : 0.,
                1e-3 * full)
        << rule;
  }
}

TEST(SpgRooms, pieces_bear_pressure_and_friction)
{
  // Compressed and sheared: mu p below the yield stress, Y/sqrt(3) above; the
  // stress of the stabilization shares the limit, and sliding turns the rest of
  // the work into heat.
  const double Y = 300e6, mu = 0.3;
  const auto law = hardening_aluminum(Y, 0.);
  const double G = law->shear_modulus(), K = law->bulk_modulus();
  for (const double p : {1e6, 100e6, 2e9})
    for (const double extra : {0., 0.5})
    {
      const double gamma = 0.05;
      FailedPoint point;
      for (int c = 0; c < 3; ++c)
        point.strain[c][0] = -p / (3. * K);
      point.strain[3][0] = 0.5 * gamma;
      const double shear_part = std::sqrt(3.) * G * gamma,
                   q = shear_part * std::hypot(1., extra);
      point.extra[0] = std::pow(extra * shear_part, 2);
      const auto rule = choose<ResidualStrength>("friction")();
      rule->set_internal_friction(mu);
      point.update(*rule, *law);
      const double pressure = -K * std::log(point.jacobian[0]),
                   bearable = std::min(Y, std::sqrt(3.) * mu * pressure);
      EXPECT_NEAR(point.stress[0][0], -pressure, 1e-9 * pressure);
      EXPECT_NEAR(std::sqrt(3.) * point.stress[3][0], bearable * shear_part / q,
                  1e-6 * bearable);
      EXPECT_NEAR(point.theta[0], bearable / q, 1e-6 * bearable / q);
      const double slid = std::max(0., q - std::sqrt(3.) * mu * pressure);
      EXPECT_NEAR(point.friction[0], 1e-9 * bearable * slid / (3. * G),
                  1e-6 * point.friction[0]);
      EXPECT_EQ(point.loss[0], 0.);
    }
}

TEST(SpgRooms, friction_of_pieces_heats_them)
{
  const auto law = metal("al6061-t6");
  FailedPoint point;
  point.strain[0][0] = point.strain[1][0] = point.strain[2][0] = -1e-3;
  point.strain[3][0] = 0.05;
  const auto rule = choose<ResidualStrength>("friction")();
  rule->set_internal_friction(0.1);
  point.update(*rule, *law);
  std::size_t row = 0;
  for (const StateVariable &variable : law->state_variables())
  {
    if (variable.name == "temperature")
    {
      EXPECT_NEAR(point.state[row] - variable.initial_value,
                  point.friction[0] / 1e-9 * point.jacobian[0] /
                      (law->density() * law->specific_heat()),
                  1e-6);
    }
    row += variable.is_tensor ? 6 : 1;
  }
  EXPECT_GT(point.friction[0], 0.);
}
} // namespace
