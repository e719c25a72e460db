#ifndef sabot_materials_mie_gruneisen_h
#define sabot_materials_mie_gruneisen_h

#include "sabot/materials/equation_of_state.h"

namespace sabot
{
/** Shock data of a metal, as in S. P. Marsh, LASL Shock Hugoniot Data (1980).
 */
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
 * eta = 1 - J, mu = 1/J - 1, g = Gamma_0 + a mu:
 *
 *   p = p_H (1 - g eta/2) + g rho_0 e,  p_H = rho_0 c_0^2 eta/(1 - s eta)^2
 *   p = rho_0 c_0^2 mu + g rho_0 e      in expansion.
 *
 * e is the specific internal energy over the initial state, with the work of
 * the deviator and of the artificial viscosity, without which a shock would
 * be isentropic; p and e are solved for together (p is linear in e). At
 * eta = 0.9/max(1, s), some tens of K, p_H goes on along its tangent: the
 * curve has a pole at 1/s. The speed of sound at rest is c_0's; Young's
 * modulus and Poisson's ratio give the shear modulus only. `stiffening` is the
 * isentropic modulus over its value at rest. (M. B. Boslough and J. R. Asay,
 * in High-Pressure Shock Compression of Solids, 1993, ch. 2.)
 */
class MieGruneisen : public EquationOfState
{
public:
  explicit MieGruneisen(const MieGruneisenParameters &p) : p(p) {}
  /** rho_0 c_0^2, which the elastic constants should nearly give, too. */
  double bulk_modulus() const override
  {
    return p.density * p.sound_speed * p.sound_speed;
  }
  std::vector<StateVariable> state_variables() const override
  {
    return {{"specific internal energy", 0., false}};
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
