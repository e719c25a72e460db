#ifndef sabot_couplings_contact_options_h
#define sabot_couplings_contact_options_h

#include "sabot/couplings/contact_spring.h"
#include "sabot/couplings/friction/friction_law.h"
#include "sabot/couplings/friction/shear_strength.h"

namespace sabot
{
/**
 * What contact and self-contact have in common: the spring, the law of
 * friction, and what the metals bear of it. The force of friction on a node is
 * at most what the law asks for and the shear strength times the node's area
 * (ContactPoints::find_forces()).
 */
struct ContactOptions : SpringOptions
{
  std::shared_ptr<const FrictionLaw> friction; // null: none
  ShearStrength shear_strength;

  /** With the entries of all laws of friction. */
  static void declare_parameters(Parameters &prm);
  /** From the present subsection, called @p path in messages; throws
      InputError. */
  void parse_parameters(const Parameters &prm, const std::string &path);
};
} // namespace sabot

#endif
