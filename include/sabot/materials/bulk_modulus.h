#ifndef sabot_materials_bulk_modulus_h
#define sabot_materials_bulk_modulus_h

#include "sabot/materials/equation_of_state.h"

namespace sabot
{
/**
 * p = -K ln J, with K of the elastic constants: the integral of the rate form
 * dp = -K tr(D) dt, so that it goes with the hypoelastic deviator. Isothermal
 * and without memory; p has no bound in compression (J -> 0). Not from a
 * paper.
 */
class BulkModulus : public EquationOfState
{
public:
  /** @p K in Pa. */
  explicit BulkModulus(const double K) : K(K) {}
  double bulk_modulus() const override { return K; }
  bool is_linear() const override { return true; }
  void finish(const MaterialBatch &batch, const Start &,
              const double) const override;

private:
  const double K; // [Pa]
};
} // namespace sabot

#endif
