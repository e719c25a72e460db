#ifndef sabot_materials_equation_of_state_h
#define sabot_materials_equation_of_state_h

#include "sabot/materials/material.h"

namespace sabot
{
/**
 * The pressure of a material (positive in compression), composed with any law:
 * one object, chosen once, called once per batch before and after the law,
 * which sees deviators only. A new one is one file with a class, its entries
 * and, on its last line, its registration:
 *
 *     const Registry<EquationOfState>::Add registered(
 *         {"Bulk modulus", "pressure -K ln J ...", nullptr, make});
 *
 * Its entries stand in a subsection of its name, below the material's. No
 * function is collective.
 *
 * The internal energy that an equation may follow is that of the point alone:
 * the work of its stresses, the deviator's and the viscous pressure's included;
 * what conduction brings is the temperature's business. Volume enters as
 * J = rho_0/rho = det F, of the whole motion, not by integrating a rate.
 */
class EquationOfState
{
public:
  static constexpr const char *kind = "equation of state";
  /** Makes one from the entries that its subsection holds, which the caller
      has entered; @p path of that subsection, for messages. What contradicts
      @p elastic goes to @p warnings; InputError for what cannot be. */
  using Make = std::shared_ptr<const EquationOfState>(
      const Parameters &prm, const std::string &path,
      const ElasticConstants &elastic, std::vector<std::string> &warnings);

  /** What is kept of the start of the step, per point of the batch. */
  struct Start
  {
    double pressure[max_batch_points];        // [Pa]
    double deviatoric_work[max_batch_points]; // 1/2 s_old : d_eps [J/m^3]
  };
  virtual ~EquationOfState() = default;

  /** dp/d(-ln J) at J = 1 [Pa], for the speed of sound and the step. */
  virtual double bulk_modulus() const = 0;
  /** State variables of its own, which stand before the law's. */
  virtual std::vector<StateVariable> state_variables() const { return {}; }
  /** Whether the pressure is that of a constant bulk modulus. */
  virtual bool is_linear() const { return false; }
  /** Whether finish() reads MaterialBatch::viscous_pressure. */
  virtual bool needs_viscous_pressure() const { return false; }
  /** Whether finish() writes MaterialBatch::stiffening. */
  virtual bool stiffens() const { return false; }
  /** Called first: @p batch holds the old stress, rotated to the new time. */
  virtual void begin(const MaterialBatch & /*batch*/, Start & /*start*/) const
  {
  }
  /** Called after the law: subtract the new pressure from the normal
      components of the new deviator; the states of @p batch are this object's.
      @p shear_modulus at rest [Pa], for the stiffening. */
  virtual void finish(const MaterialBatch &batch, const Start &start,
                      const double shear_modulus) const = 0;
};
} // namespace sabot

#endif
