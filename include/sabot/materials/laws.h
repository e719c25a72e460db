#ifndef sabot_materials_laws_h
#define sabot_materials_laws_h

#include "sabot/materials/elastic_base.h"

namespace sabot
{
/** Hypoelastic with the Jaumann rate; pressure -K ln J. */
class Elastic : public ElasticBase
{
public:
  using ElasticBase::ElasticBase;
  std::vector<StateVariable> state_variables() const override { return {}; }
  void update(const MaterialBatch &batch) const override;
};

/** J2 plasticity with linear mixed hardening. */
struct HardeningParameters
{
  double yield_stress = 0.;       // [Pa]
  double hardening_modulus = 0.;  // d sigma_y / d eps_p [Pa]
  double isotropic_fraction = 1.; // 1: isotropic, 0: kinematic
};

/**
 * Radial return in closed form (Simo & Hughes 1998, box 3.2): with
 * xi = s - alpha, f = q(xi) - sigma_y(eps), d_eps = f / (3 G + H),
 * d_alpha = (1 - beta) 2/3 H d_eps * 3/2 xi/q.
 */
class HardeningPlasticity : public ElasticBase
{
public:
  HardeningPlasticity(const ElasticConstants &elastic,
                      const HardeningParameters &parameters)
      : ElasticBase(elastic), parameters(parameters)
  {
  }
  std::vector<StateVariable> state_variables() const override;
  void update(const MaterialBatch &batch) const override;

private:
  const HardeningParameters parameters;
};

/** Johnson & Cook 1983. */
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
};

/**
 * sigma_y = (A + B eps^n)(1 + C ln eps*)(1 - T*^m), eps* = rate/reference >= 1,
 * T* = (T - T_room)/(T_melt - T_room) in [0, 1]. Implicit in strain and rate
 * (safeguarded Newton on yielding points), explicit in temperature; adiabatic
 * heating dT = eta sigma_eq d_eps / (rho c_p) with the initial density.
 */
class JohnsonCook : public ElasticBase
{
public:
  JohnsonCook(const ElasticConstants &elastic,
              const JohnsonCookParameters &parameters)
      : ElasticBase(elastic), parameters(parameters)
  {
  }
  std::vector<StateVariable> state_variables() const override;
  void update(const MaterialBatch &batch) const override;
  /** Flow stress [Pa]; the slope with eps is returned through @p slope. */
  double flow_stress(const double eps, const double rate, const double thermal,
                     const double dt, double &slope) const;
  /** 1 - T*^m. */
  double thermal_factor(const double temperature) const;

private:
  double plastic_increment(const double q, const double eps,
                           const double thermal, const double dt) const;
  const JohnsonCookParameters parameters;
};
} // namespace sabot

#endif
