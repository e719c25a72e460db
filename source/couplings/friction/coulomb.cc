// Coulomb friction with an exponential decay over the speed of sliding.
#include "sabot/couplings/friction/coulomb.h"

#include <cmath>

namespace sabot
{
namespace
{
void declare(Parameters &prm)
{
  prm.declare_entry("Friction coefficient", "0",
                    quantity(Dimension::none, 0., 2.), "Coulomb friction.");
  prm.declare_entry("Dynamic friction coefficient", "as at rest",
                    word_or("as at rest", quantity(Dimension::none, -1., 2.)),
                    "Coulomb friction mu_d of fast sliding: mu_d + (mu_s - "
                    "mu_d) exp(-decay speed), mu_s the friction coefficient; "
                    "as at rest, or below 0: mu_s.");
  prm.declare_entry("Friction decay", "0", quantity(Dimension::none, 0.),
                    "Decay of friction with the speed of sliding, in s/m.");
}

std::unique_ptr<FrictionLaw> make(const Parameters &prm,
                                  const std::string &path)
{
  const double at_rest = get_quantity(prm, "Friction coefficient"),
               decay = get_quantity(prm, "Friction decay");
  std::optional<double> sliding =
      get_optional_quantity(prm, "Dynamic friction coefficient");
  if (sliding && *sliding < 0.)
    sliding.reset();
  if (sliding && *sliding > at_rest)
    throw InputError(path + "/Dynamic friction coefficient",
                     "is above the friction coefficient, that of rest");
  if (!sliding && decay > 0.)
    throw InputError(path + "/Friction decay",
                     "needs a dynamic friction coefficient");
  return std::make_unique<Coulomb>(at_rest, sliding, decay);
}

const Registry<FrictionLaw>::Add registered(
    {"Coulomb",
     "a coefficient times the normal force, which may decay with speed.",
     declare, make});
} // namespace

double Coulomb::coefficient(const double speed) const
{
  if (!sliding)
    return at_rest;
  return *sliding + (at_rest - *sliding) * std::exp(-decay * speed);
}

void Coulomb::find_friction(const SlidingContacts &contacts,
                            std::vector<double> &friction) const
{
  for (std::size_t i = 0; i < friction.size(); ++i)
    friction[i] = coefficient(contacts.speed[i]) * contacts.pressing[i];
}
} // namespace sabot
