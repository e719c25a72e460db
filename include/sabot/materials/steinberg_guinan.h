#ifndef sabot_materials_steinberg_guinan_h
#define sabot_materials_steinberg_guinan_h

#include "sabot/materials/rate_dependent.h"

namespace sabot
{
/**
 * D. J. Steinberg, S. G. Cochran and M. W. Guinan, A constitutive model for
 * metals applicable at high-strain rate, J. Appl. Phys. 51 (1980) 1498, doi
 * 10.1063/1.327799. Letters as there.
 * Checked where the file is read: Y_0 > 0 and Y_max >= Y_0, else InputError by
 * the entry.
 */
struct SteinbergGuinanParameters
{
  double yield_stress = 0.; // Y_0 [Pa]
  /**
   * Bounds the hardened stress before it is scaled with G/G_0: under pressure
   * the flow stress may exceed it.
   */
  double largest_yield_stress = 0.;   // Y_max [Pa]
  double beta = 0., n = 0.;           // work hardening
  double initial_plastic_strain = 0.; // eps_i
  /**
   * Pressure is positive in compression, so a positive A makes the metal
   * stiffer under shock.
   */
  double pressure_coefficient = 0.;    // A = G'_p/G_0 [1/Pa]
  double temperature_coefficient = 0.; // B = -G'_T/G_0 [1/K]
  double reference_temperature = 300.; // [K]
  double melt_temperature = 1000.;     // T_m0 [K]
  /**
   * Of the law of Lindemann for T_m alone; an equation of state has a
   * coefficient of its own.
   */
  double gruneisen = 2.;        // gamma_0 of the melting law
  double melt_correction = 1.5; // a
};

/**
 * The Flow (see RateDependentPlasticity)
 *
 * G/G_0 = 1 + A p J^(1/3) - B (T - T_ref),
 * Y = min(Y_0 (1 + beta (eps + eps_i))^n, Y_max) G/G_0,
 * T_m = T_m0 exp(2 a (1 - J)) J^(-2 (gamma_0 - a - 1/3)),
 *
 * with J^-1 the compression rho/rho_0. There is no rate effect: the model is
 * meant for rates above 1e5 1/s. At T >= T_m neither strength nor shear
 * modulus is left, and neither is ever negative.
 *
 * Temperature and pressure are those of the start of the step, so that the
 * return has one unknown; G is as of the start, too, in the trial deviator.
 * With this law the shear modulus follows the pressure: the stable step needs
 * `stiffening`, for which after_pressure() takes the larger of both moduli.
 */
struct SteinbergGuinanFlow
{
  static constexpr bool constant_shear_modulus = false;
  template <typename Number>
  struct Point
  {
    Number factor; // G/G_0, of shear modulus and yield stress alike
  };
  SteinbergGuinanParameters p;

  /**
   * T_m [K] at volume ratio @p J.
   * The paper's form, in eta = rho/rho_0 = 1/J, is T_m0 exp(2 a (1 - 1/eta))
   * eta^(2 (gamma_0 - a - 1/3)); near J = 1 it rises with compression where
   * gamma_0 > 1/3. @pre J > 0.
   */
  double melt_temperature(const double J) const
  {
    return melt_temperature(J, std::log(J));
  }
  /**
   * @p temperature [K] and @p pressure [Pa] of the start of the step.
   *   factor = max(0, 1 + A p J^(1/3) - B (T - T_ref)), 0 at T >= T_m(J),
   * with p positive in compression; J^(1/3) is the paper's eta^(-1/3).
   */
  template <typename Number>
  Point<Number> at(const Number temperature, const Number pressure,
                   const Number J) const
  {
    const Number factor = pack_max(
        1. + p.pressure_coefficient * pressure * pack_cbrt(J) -
            p.temperature_coefficient * (temperature - p.reference_temperature),
        Number{});
    // Most metal is too cold to be asked whether it melts.
    if (!any_of(temperature >= cold_temperature(J)))
      return {factor};
    return {temperature < melt_temperature(J, pack_log(J)) ? factor : Number{}};
  }
  /**
   * Y grows with strain from Y_0 (1 + beta eps_i)^n, which is at least Y_0, and
   * is cut at Y_max.
   */
  template <typename Number>
  Number lower_bound(const Point<Number> &point) const
  {
    return point.factor * std::min(p.yield_stress, p.largest_yield_stress);
  }
  /** Not asked for, as the modulus moves: none without pressure and volume. */
  double smallest_stress(const double) const { return 0.; }
  /**
   * Y [Pa]; without slope once Y_max is reached.
   * The slope is Y_0 n beta (1 + beta (eps + eps_i))^(n - 1) G/G_0; rate and
   * step have no part in it.
   */
  template <typename Number>
  Number stress(const Point<Number> &point, const Number eps, const Number,
                const double, Number &slope) const
  {
    const Number base = 1. + p.beta * (eps + p.initial_plastic_strain),
                 hardened = p.yield_stress * pack_power(base, p.n),
                 largest = splat<Number>(p.largest_yield_stress);
    slope = hardened < largest ? point.factor * (p.n * p.beta) * hardened / base
                               : Number{};
    return point.factor * pack_min(hardened, largest);
  }
  /**
   * Y and G scale alike, so that the elastic strain at yield does not change
   * with pressure or temperature.
   */
  template <typename Number>
  Number shear_factor(const Point<Number> &point) const
  {
    return point.factor;
  }

private:
  /** A temperature below T_m(J), without logarithm and exponential: exp x >= 1
      + x, and 1 - 1/J <= ln J <= J - 1. The last factor is for rounding. */
  template <typename Number>
  Number cold_temperature(const Number J) const
  {
    const double power = 2. * (p.gruneisen - p.melt_correction - 1. / 3.);
    const Number logarithm = power > 0. ? J - 1. : 1. - 1. / J;
    return (1. - 1e-9) * p.melt_temperature *
           (1. + 2. * p.melt_correction * (1. - J) - power * logarithm);
  }
  template <typename Number>
  Number melt_temperature(const Number J, const Number log_J) const
  {
    return p.melt_temperature *
           pack_exp(2. * p.melt_correction * (1. - J) -
                    2. * (p.gruneisen - p.melt_correction - 1. / 3.) * log_J);
  }
};

/**
 * States are those of RateDependentPlasticity; slow loading, where the yield
 * stress depends on rate, is beyond the model.
 */
using SteinbergGuinan = RateDependentPlasticity<SteinbergGuinanFlow>;
} // namespace sabot

#endif
