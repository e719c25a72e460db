// The entries that contact and self-contact share.
#include "sabot/couplings/contact_options.h"

namespace sabot
{
void ContactOptions::declare_parameters(Parameters &prm)
{
  Registry<FrictionLaw>::declare_choice(prm, "Friction law", "Coulomb",
                                        "How friction answers to pressure and "
                                        "sliding.");
  Registry<FrictionLaw>::declare_entries(prm, "");
  ShearStrength::declare_parameters(prm);
  SpringOptions::declare_parameters(prm);
}

void ContactOptions::parse_parameters(const Parameters &prm,
                                      const std::string &path)
{
  SpringOptions::parse_parameters(prm);
  friction = Registry<FrictionLaw>::get(path + "/Friction law",
                                        prm.get("Friction law"))
                 .make(prm, path);
  shear_strength.parse_parameters(prm);
}
} // namespace sabot
