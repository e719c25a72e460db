#ifndef sabot_materials_equation_of_state_h
#define sabot_materials_equation_of_state_h

#include "sabot/materials/material.h"

namespace sabot
{
struct ElasticConstants;

/**
 * The pressure of a material, composed with any law: one object, chosen once,
 * called once per batch before and after the law, which sees deviators only.
 */
class EquationOfState
{
public:
  /** What is kept of the start of the step. */
  struct Start
  {
    double pressure[max_batch_points];        // [Pa]
    double deviatoric_work[max_batch_points]; // 1/2 s_old : d_eps [J/m^3]
  };
  virtual ~EquationOfState() = default;

  virtual double bulk_modulus() const = 0; // at rest [Pa]
  virtual std::vector<StateVariable> state_variables() const { return {}; }
  virtual bool needs_viscous_pressure() const { return false; }
  virtual bool stiffens() const { return false; }
  /** @p batch holds the old stress, rotated. */
  virtual void begin(const MaterialBatch & /*batch*/, Start & /*start*/) const
  {
  }
  /** Subtract the new pressure from the new deviator; the states of
      @p batch are this object's. @p shear_modulus at rest [Pa]. */
  virtual void finish(const MaterialBatch &batch, const Start &start,
                      const double shear_modulus) const = 0;

  static void declare_parameters(Parameters &prm, const std::string &selected);
  /** Messages about values that contradict @p elastic go to @p warnings. */
  static std::shared_ptr<const EquationOfState>
  make(Parameters &prm, const std::string &path,
       const ElasticConstants &elastic, std::vector<std::string> &warnings);
  static std::vector<std::string> names();
};

/** p = -K ln J. */
class BulkModulus : public EquationOfState
{
public:
  explicit BulkModulus(const double K) : K(K) {}
  double bulk_modulus() const override { return K; }
  void finish(const MaterialBatch &batch, const Start &,
              const double) const override;

private:
  const double K;
};

struct MieGruneisenParameters
{
  double density = 0.;           // rho_0 [kg/m^3]
  double sound_speed = 0.;       // c_0 [m/s]
  double shock_slope = 0.;       // s of U_s = c_0 + s u_p
  double gruneisen = 0.;         // Gamma_0
  double volume_correction = 0.; // a of Gamma rho = (Gamma_0 + a mu) rho_0
};

/**
 * Mie-Grueneisen pressure about the Hugoniot U_s = c_0 + s u_p, with
 * eta = 1 - J, mu = 1/J - 1, g = Gamma_0 + a mu (doc/materials.md):
 *
 *   p = p_H (1 - g eta/2) + g rho_0 e,  p_H = rho_0 c_0^2 eta/(1 - s eta)^2
 *   p = rho_0 c_0^2 mu + g rho_0 e      in expansion.
 *
 * e is the specific internal energy over the initial state, with the work of
 * the deviator and of the artificial viscosity, without which a shock would
 * be isentropic; p and e are solved for together (p is linear in e). At
 * eta = 0.9/max(1, s), some tens of K, p_H goes on along its tangent: the
 * curve has a pole at 1/s.
 */
class MieGruneisen : public EquationOfState
{
public:
  explicit MieGruneisen(const MieGruneisenParameters &p) : p(p) {}
  double bulk_modulus() const override
  {
    return p.density * p.sound_speed * p.sound_speed;
  }
  std::vector<StateVariable> state_variables() const override
  {
    return {{"specific internal energy", "J/kg", 0., false}};
  }
  bool needs_viscous_pressure() const override { return true; }
  bool stiffens() const override { return true; }
  void begin(const MaterialBatch &batch, Start &start) const override;
  void finish(const MaterialBatch &batch, const Start &start,
              const double shear_modulus) const override;

private:
  const MieGruneisenParameters p;
};
} // namespace sabot

#endif
