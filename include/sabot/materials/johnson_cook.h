#ifndef sabot_materials_johnson_cook_h
#define sabot_materials_johnson_cook_h

#include "sabot/materials/rate_dependent.h"

namespace sabot
{
/**
 * G. R. Johnson and W. H. Cook, A constitutive model and data for metals
 * subjected to large strains, high strain rates and high temperatures, 7th Int.
 * Symp. Ballistics, 1983; fracture: Eng. Fract. Mech. 21 (1985) 31, doi
 * 10.1016/0013-7944(85)90052-9. Letters as there.
 *
 * The manual's entries bear the names in words: "Initial yield stress" is A,
 * "Hardening modulus" B, "Strain rate coefficient" C. Values are checked where
 * the file is read: A > 0, T_melt > T_room, and with damage a positive fracture
 * strain D1 + D2 exp(D3/3) in uniaxial tension, where sigma* = 1/3.
 */
struct JohnsonCookParameters
{
  double A = 0., B = 0.; // initial yield stress, hardening [Pa]
  double n = 1.;         // exponent of hardening
  double C = 0.;         // rate coefficient
  double m = 1.;         // exponent of thermal softening
  /**
   * C depends on it: sets fitted with another reference differ by the factor 1
   * + C ln of the ratio in A and B, and by its inverse in C.
   */
  double reference_strain_rate = 1.; // [1/s]
  /** T_room of T*, which need not be the temperature the body starts with. */
  double room_temperature = 294.;    // [K]
  double initial_temperature = 294.; // [K]
  double melt_temperature = 1000.;   // [K]
  double specific_heat = 1000.;      // [J/kg/K]
  double taylor_quinney = 0.9;       // 0 switches adiabatic heating off
  double conductivity = 0.;          // [W/m/K]
  double thermal_expansion = 0.;     // linear [1/K]
  bool has_damage = false;
  /**
   * D1, D2: strains; D3: of the triaxiality, negative for metals in the sign of
   * the code, exp(D3 sigma*); D4: of the rate; D5: of T*. All without unit.
   */
  double D[5] = {0., 0., 0., 0., 0.}; // D1 to D5
  /** Bound of the fracture strain from below, which some sets make negative at
      high triaxiality. */
  double smallest_fracture_strain = 0.01;
};

/**
 * The Flow (see RateDependentPlasticity)
 *
 *   sigma_y = (A + B eps^n)(1 + C ln eps*)(1 - T*^m),
 *
 * eps* = rate/reference, at least 1, and T* = (T - T_room)/(T_melt - T_room)
 * in [0, 1]: slower than the reference rate there is no effect of rate, below
 * room temperature no softening, above melt no strength. The slope with eps is
 * that of a step: with the rate eps/dt it has the part of the logarithm, too.
 */
struct JohnsonCookFlow
{
  static constexpr bool constant_shear_modulus = true;
  template <typename Number>
  struct Point
  {
    Number thermal; // 1 - T*^m, fixed during the return
  };
  JohnsonCookParameters p;

  /**
   * T [K] only: neither pressure nor volume has a part in this law. T* is of
   * the start of the step, an error of first order in dt in the softening.
   */
  template <typename Number>
  Point<Number> at(const Number temperature, const Number, const Number) const
  {
    return {thermal_factor(temperature)};
  }
  /**
   * A (1 - T*^m): hardening and rate only add to it, as B and C are not
   * negative.
   */
  template <typename Number>
  Number lower_bound(const Point<Number> &point) const
  {
    return point.thermal * p.A;
  }
  /**
   * A min(m, 1) (1 - T*): the chord of a convex T*^m, the tangent at melt of a
   * concave one. The last factor is for the rounding of T*^m.
   */
  double smallest_stress(const double temperature) const
  {
    const double T = homologous(temperature);
    return (1. - 1e-9) * p.A * (T > 0. ? std::min(p.m, 1.) * (1. - T) : 1.);
  }
  /**
   * sigma_y [Pa] at strain @p eps and @p rate [1/s]; strains below 1e-14 count
   * as that, where the slope of the power law has no bound.
   * With h = B eps^n and f = 1 + C ln(rate/reference),
   *   slope = (1 - T*^m)(n h/eps f + (A + h) C/(rate dt))
   * above the reference rate, without the second term below, where f = 1: the
   * kink of the rate's effect is one of the slope only.
   */
  template <typename Number>
  Number stress(const Point<Number> &point, const Number eps, const Number rate,
                const double dt, Number &slope) const
  {
    const Number safe = pack_max(eps, splat<Number>(1e-14)),
                 hardening = p.B * pack_power(safe, p.n);
    const Number relative =
        pack_max(rate * (1. / p.reference_strain_rate), splat<Number>(1.));
    const auto is_fast = relative > splat<Number>(1.);
    const Number fast =
        any_of(is_fast) ? 1. + p.C * pack_log(relative) : splat<Number>(1.);
    // One division for both: by eps and, above the reference rate, by d.
    const Number d = relative * (p.reference_strain_rate * dt),
                 inverse = 1. / (safe * d);
    slope = point.thermal * inverse *
            (p.n * hardening * fast * d +
             (is_fast ? (p.A + hardening) * p.C * safe : Number{}));
    return point.thermal * (p.A + hardening) * fast;
  }
  /** G does not follow pressure or temperature in this law. */
  template <typename Number>
  Number shear_factor(const Point<Number> &) const
  {
    return splat<Number>(1.);
  }

  /**
   * T* of @p temperature [K], within [0, 1].
   * (T - T_room)/(T_melt - T_room), the papers' T*.
   */
  template <typename Number>
  Number homologous(const Number temperature) const
  {
    const Number T = (temperature - p.room_temperature) *
                     (1. / (p.melt_temperature - p.room_temperature));
    return pack_min(splat<Number>(1.), pack_max(Number{}, T));
  }
  /**
   * 1 - T*^m of @p temperature [K].
   * 1 at room temperature and below, 0 from melt on, exactly.
   */
  template <typename Number>
  Number thermal_factor(const Number temperature) const
  {
    const Number T = homologous(temperature);
    if (!any_of(T > Number{}))
      return splat<Number>(1.);
    // 1 - 1^m is 0, as the logarithm of 1 is 0.
    return T > Number{} ? 1. - pack_power(T, p.m) : splat<Number>(1.);
  }
  /**
   * Fracture strain of Johnson & Cook 1985 at triaxiality sigma*, @p rate [1/s]
   * and @p temperature [K], see JohnsonCook::fracture_strain().
   */
  template <typename Number>
  Number fracture_strain(const Number triaxiality, const Number rate,
                         const Number temperature) const
  {
    const Number relative = pack_max(splat<Number>(1.),
                                     rate * (1. / p.reference_strain_rate)),
                 clamped = pack_min(pack_max(triaxiality, splat<Number>(-10.)),
                                    splat<Number>(1.5));
    // Many sets have no effect of the rate.
    const Number of_rate =
        p.D[3] != 0. ? 1. + p.D[3] * pack_log(relative) : splat<Number>(1.);
    return pack_max((p.D[0] + p.D[1] * pack_exp(p.D[2] * clamped)) * of_rate *
                        (1. + p.D[4] * homologous(temperature)),
                    splat<Number>(p.smallest_fracture_strain));
  }
};

/**
 * The law, and with has_damage its fracture model as the state "damage":
 * D += d_eps / eps_f,
 *
 *   eps_f = (D1 + D2 exp(D3 sigma*))(1 + D4 ln eps*)(1 + D5 T*),
 *
 * sigma* = mean stress / von Mises stress at the end of the step, at most 1.5
 * (Johnson & Cook 1985) and at least -10, eps_f not below a smallest strain.
 * Damage leaves the stress alone: what fails at D = 1 is the body's choice. It
 * goes on beyond, so that a mean over two points passes 1 where one of them has
 * not.
 */
class JohnsonCook : public RateDependentPlasticity<JohnsonCookFlow>
{
public:
  /**
   * Passes the thermal values of @p parameters on to RateDependentPlasticity;
   * throws nothing, values that cannot be are refused where the file is read.
   */
  JohnsonCook(const ElasticConstants &elastic,
              const JohnsonCookParameters &parameters, const Eos &eos = {});
  /** Flow stress [Pa] at strain @p eps, @p rate [1/s] and 1 - T*^m; its slope
      with eps at fixed @p dt is returned through @p slope. */
  double flow_stress(const double eps, const double rate,
                     const double thermal_factor, const double dt,
                     double &slope) const
  {
    return flow.stress(JohnsonCookFlow::Point<double>{thermal_factor}, eps,
                       rate, dt, slope);
  }
  /** 1 - T*^m of @p temperature [K]. */
  double thermal_factor(const double temperature) const
  {
    return flow.thermal_factor(temperature);
  }
  /**
   * eps_f at @p triaxiality sigma*, @p rate [1/s] and @p temperature [K], at
   * least the smallest.
   * @p triaxiality is clamped to [-10, 1.5] first, @p rate to the reference
   * rate from below. Without unit; the equivalent plastic strain at which D
   * reaches 1 were all three held constant (Johnson & Cook 1985).
   */
  double fracture_strain(const double triaxiality, const double rate,
                         const double temperature) const
  {
    return flow.fracture_strain(triaxiality, rate, temperature);
  }
  /** fracture_strain() at the reference rate and the initial temperature;
      nothing without damage. */
  std::optional<double>
  slow_fracture_strain(const double triaxiality) const override;

protected:
  std::vector<StateVariable> law_variables() const override;
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;
  void after_pressure(const MaterialBatch &batch,
                      const Scratch &scratch) const override;
};
} // namespace sabot

#endif
