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
            (Names{"effective plastic strain", "maximum principal stress",
                   "maximum shear strain"}));
  EXPECT_EQ(names<ResidualStrength>(), (Names{"compression", "everything"}));
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

TEST(SpgRooms, what_failed_metal_carries)
{
  // One point in uniaxial tension: all of it, or none across the crack.
  const auto law = elastic();
  for (const std::string rule : {"everything", "compression"})
  {
    double strain[6][1] = {{1e-4}}, stress[6][1] = {}, jacobian[1] = {1.0001},
           extra[1] = {}, theta[1], work[1], half_volume[1] = {0.5e-9},
           loss[1] = {};
    const char is_failed[1] = {1};
    MaterialBatch batch;
    batch.n = 1;
    batch.dt = 1e-6;
    for (int c = 0; c < 6; ++c)
    {
      batch.strain_increment[c] = strain[c];
      batch.stress[c] = stress[c];
    }
    batch.jacobian = jacobian;
    batch.states = nullptr;
    batch.extra_square = extra;
    batch.return_factor = theta;
    batch.plastic_work = work;
    choose<ResidualStrength>(rule)()->update(*law, batch,
                                             {is_failed, half_volume, loss});
    const double full =
        1e-4 * (law->bulk_modulus() + 4. / 3. * law->shear_modulus());
    EXPECT_NEAR(stress[0][0], rule == "everything" ? full : 0., 1e-3 * full)
        << rule;
  }
}
} // namespace
