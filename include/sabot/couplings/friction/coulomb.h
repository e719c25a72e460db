#ifndef sabot_couplings_friction_coulomb_h
#define sabot_couplings_friction_coulomb_h

#include "sabot/couplings/friction/friction_law.h"

#include <optional>

namespace sabot
{
/**
 * Coulomb friction mu(|v_t|) f_n with the exponential decay of Benson and
 * Hallquist (CMAME 78, 1990):
 *
 *     mu = mu_d + (mu_s - mu_d) exp(-beta |v_t|),
 *
 * mu_s at rest, mu_d of fast sliding (mu_s where there is none), beta [s/m].
 */
class Coulomb : public FrictionLaw
{
public:
  /** @p at_rest: mu_s >= 0; @p sliding: mu_d <= mu_s, none: mu_s at all speeds;
      @p decay: beta >= 0, counts only where there is mu_d. The parameter file's
      values are checked, these are not. */
  explicit Coulomb(const double at_rest,
                   const std::optional<double> &sliding = std::nullopt,
                   const double decay = 0.)
      : at_rest(at_rest), sliding(sliding), decay(decay)
  {
  }
  /** mu at the speed of sliding @p speed [m/s], between mu_d and mu_s. */
  double coefficient(const double speed) const;
  /** mu(speed) times pressing. */
  void find_friction(const SlidingContacts &contacts,
                     std::vector<double> &friction) const override;

private:
  const double at_rest;
  const std::optional<double> sliding;
  const double decay;
};

/** A law to hand to ContactOptions where no parameter file does; arguments as
    of the constructor. */
inline std::shared_ptr<const FrictionLaw>
coulomb(const double at_rest,
        const std::optional<double> &sliding = std::nullopt,
        const double decay = 0.)
{
  return std::make_shared<Coulomb>(at_rest, sliding, decay);
}
} // namespace sabot

#endif
