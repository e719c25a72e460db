#ifndef sabot_materials_elastic_base_h
#define sabot_materials_elastic_base_h

#include "sabot/materials/equation_of_state.h"
#include "sabot/materials/material.h"

namespace sabot
{
/** Density and isotropic elasticity, shared by all laws. */
struct ElasticConstants
{
  double density = 0.;       // [kg/m^3]
  double young_modulus = 0.; // [Pa]
  double poisson_ratio = 0.;

  double bulk_modulus() const
  {
    return young_modulus / (3. * (1. - 2. * poisson_ratio));
  }
  double shear_modulus() const
  {
    return young_modulus / (2. * (1. + poisson_ratio));
  }
  static void declare_parameters(Parameters &prm);
  /** Also checks that the sound speed is plausible, 100 to 20 000 m/s. */
  static ElasticConstants parse(const Parameters &prm, const std::string &path);
};

/** A law for the deviator, composed with an equation of state. */
class ElasticBase : public Material
{
public:
  using Eos = std::shared_ptr<const EquationOfState>;
  /** Without @p eos the pressure is -K ln J. */
  explicit ElasticBase(const ElasticConstants &constants, const Eos &eos = {});
  double density() const override { return constants.density; }
  double bulk_modulus() const override { return eos->bulk_modulus(); }
  double shear_modulus() const override { return G; }
  std::vector<StateVariable> state_variables() const final;
  void update(const MaterialBatch &batch) const final;
  bool needs_viscous_pressure() const override
  {
    return eos->needs_viscous_pressure();
  }
  bool stiffens() const override { return eos->stiffens(); }
  bool has_equation_of_state() const override { return !eos->is_linear(); }

protected:
  virtual std::vector<StateVariable> law_variables() const { return {}; }
  /** One number per point that a law may keep between the two calls. */
  using Scratch = double[max_batch_points];
  /** From the old stress to the new deviator; states are law_variables(). */
  virtual void update_deviator(const MaterialBatch &batch,
                               Scratch &scratch) const = 0;
  /** Called with the new stress, the pressure included. */
  virtual void after_pressure(const MaterialBatch &, const Scratch &) const {}

  /** Deviator <- deviator + 2 G dev(dE), the trial deviator; no pressure. */
  void trial_deviator(const MaterialBatch &batch) const;

  const ElasticConstants constants;
  const Eos eos;
  const double G;

private:
  const std::size_t n_eos_states;
};
} // namespace sabot

#endif
