#ifndef sabot_materials_johnson_cook_h
#define sabot_materials_johnson_cook_h

#include "sabot/materials/rate_dependent.h"

namespace sabot
{
/** Johnson & Cook 1983, fracture 1985. */
struct JohnsonCookParameters
{
  double A = 0., B = 0.; // [Pa]
  double n = 1., C = 0., m = 1.;
  double reference_strain_rate = 1.; // [1/s]
  double room_temperature = 294.;    // [K]
  double initial_temperature = 294.; // [K]
  double melt_temperature = 1000.;   // [K]
  double specific_heat = 1000.;      // [J/kg/K]
  double taylor_quinney = 0.9;       // 0 switches adiabatic heating off
  double conductivity = 0.;          // [W/m/K]
  double thermal_expansion = 0.;     // linear [1/K]
  bool has_damage = false;
  double D[5] = {0., 0., 0., 0., 0.};
  double smallest_fracture_strain = 0.01;
};

/**
 * sigma_y = (A + B eps^n)(1 + C ln eps*)(1 - T*^m), eps* = rate/reference >= 1,
 * T* = (T - T_room)/(T_melt - T_room) in [0, 1].
 */
struct JohnsonCookFlow
{
  static constexpr bool constant_shear_modulus = true;
  struct Point
  {
    double thermal; // 1 - T*^m
  };
  JohnsonCookParameters p;

  Point at(const double temperature, const double, const double) const
  {
    return {thermal_factor(temperature)};
  }
  double lower_bound(const Point &point) const { return point.thermal * p.A; }
  double stress(const Point &point, const double eps, const double rate,
                const double dt, double &slope) const
  {
    const double safe = std::max(eps, 1e-14);
    const double hardening = p.B * std::pow(safe, p.n);
    const double relative = rate / p.reference_strain_rate;
    const double fast = relative > 1. ? 1. + p.C * std::log(relative) : 1.;
    const double fast_slope = relative > 1. ? p.C / (rate * dt) : 0.;
    slope = point.thermal *
            (p.n * hardening / safe * fast + (p.A + hardening) * fast_slope);
    return point.thermal * (p.A + hardening) * fast;
  }
  double shear_factor(const Point &) const { return 1.; }

  double homologous(const double temperature) const
  {
    return std::min(
        1., std::max(0., (temperature - p.room_temperature) /
                             (p.melt_temperature - p.room_temperature)));
  }
  double thermal_factor(const double temperature) const
  {
    const double T = homologous(temperature);
    return T <= 0. ? 1. : T >= 1. ? 0. : 1. - std::pow(T, p.m);
  }
};

/**
 * The law, and with has_damage its fracture model as the state "damage":
 * D += d_eps / eps_f, at most 1,
 *
 *   eps_f = (D1 + D2 exp(D3 sigma*))(1 + D4 ln eps*)(1 + D5 T*),
 *
 * sigma* = mean stress / von Mises stress at the end of the step, at most 1.5
 * (Johnson & Cook 1985) and at least -10, eps_f not below a smallest strain.
 * Damage leaves the stress alone: what fails at D = 1 is the body's choice.
 */
class JohnsonCook : public RateDependentPlasticity<JohnsonCookFlow>
{
public:
  JohnsonCook(const ElasticConstants &elastic,
              const JohnsonCookParameters &parameters, const Eos &eos = {});
  /** Flow stress [Pa]; the slope with eps is returned through @p slope. */
  double flow_stress(const double eps, const double rate,
                     const double thermal_factor, const double dt,
                     double &slope) const
  {
    return flow.stress({thermal_factor}, eps, rate, dt, slope);
  }
  /** 1 - T*^m. */
  double thermal_factor(const double temperature) const
  {
    return flow.thermal_factor(temperature);
  }
  /** eps_f at stress triaxiality @p triaxiality. */
  double fracture_strain(const double triaxiality, const double rate,
                         const double temperature) const;

protected:
  std::vector<StateVariable> law_variables() const override;
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;
  void after_pressure(const MaterialBatch &batch,
                      const Scratch &scratch) const override;
};
} // namespace sabot

#endif
