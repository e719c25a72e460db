#ifndef sabot_materials_zerilli_armstrong_h
#define sabot_materials_zerilli_armstrong_h

#include "sabot/materials/rate_dependent.h"

namespace sabot
{
/**
 * F. J. Zerilli and R. W. Armstrong, Dislocation-mechanics-based constitutive
 * relations for material dynamics calculations, J. Appl. Phys. 61 (1987) 1816,
 * doi 10.1063/1.338024. Letters as there, C0 with the part of the grain size.
 * The paper's fit of copper is C0 = 65 MPa, C2 = 890 MPa, C3 = 0.0028 1/K, C4 =
 * 0.000115 1/K. Read with C0 > 0, else InputError; the others are at least zero
 * by the entries' bounds.
 */
struct ZerilliArmstrongParameters
{
  bool is_bcc = false;
  /**
   * Delta sigma_G' + k l^(-1/2) of the paper: solutes and initial dislocations,
   * and the grain size by Hall and Petch.
   */
  double C0 = 0.; // athermal and grain-size part [Pa]
  double C1 = 0.; // bcc, thermal part [Pa]
  double C2 = 0.; // fcc, thermal part [Pa]
  /**
   * Of the thermal activation: softening, and the effect of rate, which needs
   * rates in 1/s as C3 holds the logarithm of the unit.
   */
  double C3 = 0., C4 = 0.;         // [1/K]
  double C5 = 0., n = 1.;          // bcc, hardening [Pa]
  double melt_temperature = 1000.; // [K]
};

/**
 * The Flow (see RateDependentPlasticity) of one lattice:
 *
 * fcc: sigma = C0 + C2 sqrt(eps) exp(-C3 T + C4 T ln rate),
 * bcc: sigma = C0 + C1 exp(-C3 T + C4 T ln rate) + C5 eps^n,
 *
 * T in K, rate in 1/s, not below 1e-12 1/s, where the logarithm would end. The
 * law has no melting; at T >= T_m, a parameter of its own, strength is 0.
 *
 * The exponent of the rate is C4 T: exp(C4 T ln rate) = rate^(C4 T), so that
 * the effect of rate grows with temperature while exp(-C3 T) takes strength
 * away. The slope with eps holds the rate's part, as strain and rate grow
 * together within a step.
 */
template <bool bcc>
struct ZerilliArmstrongFlow
{
  static constexpr bool constant_shear_modulus = true;
  template <typename Number>
  struct Point
  {
    Number athermal;  // C0 [Pa]
    Number thermal;   // C1 or C2 times exp(-C3 T) [Pa]
    Number exponent;  // C4 T: of the rate
    Number hardening; // C5 [Pa]
  };
  ZerilliArmstrongParameters p;

  /**
   * Above melt all four are zero, and with them strength and slope. The
   * exponential of T is taken once per point, before the return.
   */
  template <typename Number>
  Point<Number> at(const Number temperature, const Number, const Number) const
  {
    const Number solid = temperature < splat<Number>(p.melt_temperature)
                             ? splat<Number>(1.)
                             : Number{};
    return {p.C0 * solid,
            (bcc ? p.C1 : p.C2) * solid * pack_exp(-p.C3 * temperature),
            p.C4 * solid * temperature, p.C5 * solid};
  }
  /**
   * C0: neither strain nor rate take anything off.
   * Both other terms are at least zero, so sigma >= C0 below melt.
   */
  template <typename Number>
  Number lower_bound(const Point<Number> &point) const
  {
    return point.athermal;
  }
  /** C0 below melt. */
  double smallest_stress(const double temperature) const
  {
    return temperature < p.melt_temperature ? p.C0 : 0.;
  }
  /**
   * With t = thermal rate^(C4 T) the slope is, at strain rate above 1e-12 1/s,
   *   fcc: sqrt(eps) t C4 T/(rate dt) + t/(2 sqrt(eps)),
   *   bcc: t C4 T/(rate dt) + n C5 eps^n/eps.
   * @p rate [1/s], @p dt [s]; strains below 1e-14 count as that.
   */
  template <typename Number>
  Number stress(const Point<Number> &point, const Number eps, const Number rate,
                const double dt, Number &slope) const
  {
    const Number slowest = splat<Number>(1e-12), r = pack_max(rate, slowest),
                 safe = pack_max(eps, splat<Number>(1e-14)),
                 thermal =
                     point.thermal * pack_exp(point.exponent * pack_log(r)),
                 d = r * dt, inverse = 1. / (safe * d);
    const Number by_rate =
        rate > slowest ? thermal * point.exponent * safe : Number{};
    if constexpr (bcc)
    {
      const Number hardening = point.hardening * pack_power(safe, p.n);
      slope = inverse * (by_rate + p.n * hardening * d);
      return point.athermal + thermal + hardening;
    }
    else
    {
      const Number root = pack_sqrt(safe);
      slope = inverse * root * (by_rate + 0.5 * thermal * d);
      return point.athermal + thermal * root;
    }
  }
  /** The paper has no law for G: it is constant. */
  template <typename Number>
  Number shear_factor(const Point<Number> &) const
  {
    return splat<Number>(1.);
  }
};

/** Copper, aluminum, nickel: the effect of rate grows with strain. */
using ZerilliArmstrongFcc =
    RateDependentPlasticity<ZerilliArmstrongFlow<false>>;
/** Iron, tantalum, tungsten: rate and strain add. */
using ZerilliArmstrongBcc = RateDependentPlasticity<ZerilliArmstrongFlow<true>>;
} // namespace sabot

#endif
