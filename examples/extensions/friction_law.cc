// Adds the friction law "flash heating": the tips that carry two surfaces melt
// once they slide too fast,
//
//   mu = mu_w + (mu_0 - mu_w) V_w/V  for V > V_w,  else mu_0,
//
// V the speed of sliding (J. R. Rice, Heating and weakening of faults during
// earthquake slip, J. Geophys. Res. 111 (2006) B05311, doi
// 10.1029/2005JB004006, section on flash heating). To keep it, copy this file
// into source/couplings/friction. Scene: friction_law.prm.
#include "sabot/couplings/friction/friction_law.h"

#include <algorithm>

namespace sabot
{
namespace
{
struct FlashHeatingParameters
{
  double slow = 0.;            // mu_0
  double weakened = 0.;        // mu_w
  double weakening_speed = 1.; // V_w [m/s]
};

void declare(Parameters &prm)
{
  prm.declare_entry("Slow friction coefficient", "0",
                    quantity(Dimension::none, 0., 2.),
                    "Flash heating, mu0: below the weakening speed.");
  prm.declare_entry("Weakened friction coefficient", "0",
                    quantity(Dimension::none, 0., 2.),
                    "Flash heating, mu_w: of very fast sliding.");
  prm.declare_entry("Weakening speed", "1 m/s",
                    quantity(Dimension::velocity, 1e-6, 1e5),
                    "Flash heating, V_w: where friction begins to fall.");
}

class FlashHeating : public FrictionLaw
{
public:
  explicit FlashHeating(const FlashHeatingParameters &p) : p(p) {}
  void find_friction(const SlidingContacts &contacts,
                     std::vector<double> &friction) const override
  {
    for (std::size_t i = 0; i < friction.size(); ++i)
    {
      const double part =
          p.weakening_speed / std::max(contacts.speed[i], p.weakening_speed);
      friction[i] =
          (p.weakened + (p.slow - p.weakened) * part) * contacts.pressing[i];
    }
  }

private:
  const FlashHeatingParameters p;
};

const Registry<FrictionLaw>::Add
    registered({"flash heating",
                "falls with the inverse of the speed of sliding.", declare,
                [](const Parameters &prm, const std::string &path)
                {
                  FlashHeatingParameters p;
                  p.slow = get_quantity(prm, "Slow friction coefficient");
                  p.weakened =
                      get_quantity(prm, "Weakened friction coefficient");
                  p.weakening_speed = get_quantity(prm, "Weakening speed");
                  if (p.weakened > p.slow)
                    throw InputError(path + "/Weakened friction coefficient",
                                     "is above the slow friction coefficient");
                  return std::make_unique<FlashHeating>(p);
                }});
} // namespace
} // namespace sabot
