// The energy that an equation of state follows where metal has failed.
#include "sabot/base/choice.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/law_arrays.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

/** A failed point whose volume goes as told. */
class FailedPoint
{
public:
  explicit FailedPoint(const std::string &rule)
      : law({aluminum().density, 70e9, 0.33},
            std::make_shared<MieGruneisen>(
                mie_gruneisen_parameters("al6061-t6-eos"))),
        rule(choose<ResidualStrength>(rule)())
  {
    this->rule->set_internal_friction(0.3);
    arrays.jacobian[0] = 1.;
  }
  /** To the volume ratio @p J in @p n steps, each alike in all directions. */
  void strain_to(const double J, const int n)
  {
    const double change = (J - arrays.jacobian[0]) / n;
    for (int i = 0; i < n; ++i)
    {
      const double mid = arrays.jacobian[0] + 0.5 * change;
      for (int c = 0; c < 3; ++c)
        arrays.strain[c][0] = change / mid / 3.;
      arrays.jacobian[0] += change;
      double *const states[1] = {energy};
      rule->update(law, arrays.batch(law, 1, 1e-9, states),
                   {failed, half_volume, loss, friction});
    }
  }
  double pressure() const
  {
    return -(arrays.stress[0][0] + arrays.stress[1][0] + arrays.stress[2][0]) /
           3.;
  }

  const Elastic law;
  double energy[max_batch_points] = {}; // [J/kg]

private:
  const std::unique_ptr<ResidualStrength> rule;
  LawArrays arrays;
  const char failed[max_batch_points] = {1};
  const double half_volume[max_batch_points] = {0.5};
  double loss[max_batch_points] = {}, friction[max_batch_points] = {};
};

TEST(FailedMetal, that_gapes_keeps_the_energy_of_its_equation_of_state)
{
  for (const char *const rule : {"friction", "compression"})
  {
    FailedPoint point(rule);
    // No stress does work, in small steps and in such as debris may make.
    point.strain_to(2.5, 300);
    for (int i = 0; i < 50; ++i)
    {
      point.strain_to(1.1, 1 + i % 3);
      point.strain_to(2.5, 1 + i % 2);
    }
    EXPECT_EQ(point.pressure(), 0.) << rule;
    EXPECT_NEAR(point.energy[0], 0., 1e-6) << rule;
  }
}

TEST(FailedMetal, that_has_gaped_closes_at_its_own_volume)
{
  for (const char *const rule : {"friction", "compression", "everything"})
  {
    // Metal that never gaped, at the same volume.
    FailedPoint straight("everything"), point(rule);
    straight.strain_to(0.95, 200);
    if (std::string(rule) != "everything")
    {
      point.strain_to(1.8, 100);
      point.strain_to(1.02, 100);
      EXPECT_EQ(point.pressure(), 0.) << rule;
      point.strain_to(1., 1);
    }
    point.strain_to(0.95, 200);
    EXPECT_NEAR(point.pressure() / straight.pressure(), 1., 1e-3) << rule;
  }
}
} // namespace
