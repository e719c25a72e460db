#ifndef sabot_couplings_friction_shear_strength_h
#define sabot_couplings_friction_shear_strength_h

#include <algorithm>
#include <cmath>
#include <optional>

namespace sabot
{
class Parameters;

/**
 * Friction per area that metals bear, whatever the law of friction asks for:
 * any (no limit), a given stress, or the shear flow stress Y/sqrt(3) of the
 * softer side (von Mises in simple shear), Y the uniaxial flow stress of the
 * metal that touches, with its present plastic strain, temperature and
 * pressure, at no rate, as of the last search.
 */
class ShearStrength
{
public:
  /** Friction without a limit. */
  ShearStrength() = default;
  /** @p tau: [Pa], > 0. */
  static ShearStrength given(const double tau);
  /** From the present flow stresses of the two sides. */
  static ShearStrength of_yield();

  /** The entry `Shear strength`: `none`, `yield`, or a stress. */
  static void declare_parameters(Parameters &prm);
  void parse_parameters(const Parameters &prm);

  /** False: areas of contact need not be known. */
  bool is_limited() const { return from_yield || stress.has_value(); }
  /** Whether of_metals() needs flow stresses; if not, they are not asked for.
   */
  bool needs_flow_stress() const { return from_yield; }
  /** Where no flow stress is needed [Pa]; no limit: a stress beyond all. */
  double value() const { return stress.value_or(unlimited); }
  /** Of two sides with the uniaxial flow stresses @p a and @p b [Pa]. */
  static double of_metals(const double a, const double b)
  {
    return std::min(a, b) / std::sqrt(3.);
  }

private:
  // Finite, so that times an area of zero it is zero.
  static constexpr double unlimited = 1e300;
  std::optional<double> stress; // [Pa]
  bool from_yield = false;
};
} // namespace sabot

#endif
