// The entry that holds friction below what the touching metals bear.
#include "sabot/couplings/friction/shear_strength.h"

#include "sabot/base/parameters.h"

namespace sabot
{
ShearStrength ShearStrength::given(const double tau)
{
  ShearStrength strength;
  strength.stress = tau;
  return strength;
}

ShearStrength ShearStrength::of_yield()
{
  ShearStrength strength;
  strength.from_yield = true;
  return strength;
}

void ShearStrength::declare_parameters(Parameters &prm)
{
  prm.declare_entry(
      "Shear strength", "none",
      word_or("none", word_or("yield", quantity(Dimension::pressure, 0.))),
      "Friction per area stays below it; yield: the present flow stress of the "
      "softer side, where it is touched, over sqrt(3). none, or 0: no limit.");
}

void ShearStrength::parse_parameters(const Parameters &prm)
{
  const std::string text = prm.get("Shear strength");
  *this = text == "yield" ? of_yield() : ShearStrength();
  if (text == "yield" || text == "none")
    return;
  const double tau = get_quantity(prm, "Shear strength");
  if (tau > 0.)
    *this = given(tau);
}
} // namespace sabot
