#ifndef sabot_couplings_friction_friction_law_h
#define sabot_couplings_friction_friction_law_h

#include "sabot/base/registry.h"

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** What presses and slides in one step, as arrays of equal length, one entry
    per contact point that this rank computes. */
struct SlidingContacts
{
  std::vector<double> pressing; // normal force, damping included [N], >= 0
  std::vector<double> speed;    // of sliding, |v - (v . n) n| [m/s], >= 0
  std::vector<double> area;     // that the point stands for [m^2]
};

/**
 * Size of the friction between two surfaces that slide on each other; it acts
 * against the sliding. A law says what the pair of surfaces would like. Whoever
 * asks then holds it below what the metals bear (ShearStrength), and has less
 * than it of what sticks (spring_friction()).
 *
 * A law is one file in source/couplings/friction that ends with
 *
 *     const Registry<FrictionLaw>::Add law({"Name", "description", declare,
 *                                           make});
 *
 * `set Friction law = Name` in a contact or self-contact chooses it; its own
 * entries then stand in the same subsection.
 */
class FrictionLaw
{
public:
  static constexpr const char *kind = "friction law";
  /** Reads and checks the law's entries in the present subsection, called
      @p path in messages; throws InputError. */
  using Make = std::unique_ptr<FrictionLaw>(const Parameters &prm,
                                            const std::string &path);
  virtual ~FrictionLaw() = default;

  /** Sets @p friction [N], >= 0, for all @p contacts: called once a step, so
      that the choice of the law costs nothing per point. Local to a rank; what
      comes out for a point may depend on that point alone, since points across
      ranks are computed twice.
      @param friction: as long as the arrays of @p contacts. */
  virtual void find_friction(const SlidingContacts &contacts,
                             std::vector<double> &friction) const = 0;
  /** Coefficient of the friction between the pieces of metal that has failed,
      tan of their angle of internal friction, without unit: what the law makes
      of pressure alone, at no speed. */
  virtual double internal_friction() const;
};
} // namespace sabot

#endif
