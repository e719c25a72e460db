#ifndef sabot_materials_elastic_base_h
#define sabot_materials_elastic_base_h

#include "sabot/materials/equation_of_state.h"
#include "sabot/materials/material.h"

namespace sabot
{
/**
 * Density and isotropic elasticity at rest, shared by all laws:
 *
 *   K = E/(3 (1 - 2 nu)),  G = E/(2 (1 + nu)).
 *
 * With an equation of state that has a bulk modulus of its own only G counts.
 */
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
  /** "Density", "Young's modulus", "Poisson's ratio" of the present
      subsection. */
  static void declare_parameters(Parameters &prm);
  /** Reads them. InputError where density or modulus was not set, or the speed
      of sound that they give is not plausible, 100 to 20 000 m/s: then a unit
      is wrong. @p path of the material, for messages. */
  static ElasticConstants parse(const Parameters &prm, const std::string &path);
};

/**
 * A law for the deviator, composed with an equation of state: sigma = s - p 1,
 * s by the law and p by the equation. In update(), in this order:
 *
 *   1. the equation looks at the old stress (begin),
 *   2. the law makes the new deviator of it (update_deviator),
 *   3. the equation subtracts its new pressure (finish),
 *   4. the law may follow what depends on the whole stress (after_pressure).
 *
 * Of the arrays of state the equation's come first, then the law's.
 *
 * The two meet in the stress alone, so that any law goes with any equation of
 * state. What depends on the equation the law asks of it: stiffens(), and the
 * bulk modulus at rest.
 */
class ElasticBase : public Material
{
public:
  using Eos = std::shared_ptr<const EquationOfState>;
  /** Without @p eos the pressure is -K ln J. */
  explicit ElasticBase(const ElasticConstants &constants, const Eos &eos = {});
  double density() const override { return constants.density; }
  /** The equation's at rest, not the elastic constants' [Pa]. */
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
  /** State variables of the law; entry i of update_deviator's batch.state()
      is the i-th of them, a tensor counting six. */
  virtual std::vector<StateVariable> law_variables() const { return {}; }
  /** One number per point that a law may keep between the two calls. */
  using Scratch = double[max_batch_points];
  /** The points come in whole packs: batch.n is a multiple of eight, points
      that a body does not have repeat its last one. So every point goes through
      the same instructions, wherever it stands. From the old stress, rotated,
      to the new deviator (no pressure left in
      it), with return_factor, plastic_work and the states, which are
      law_variables(), of every point. @p scratch: see after_pressure(). */
  virtual void update_deviator(const MaterialBatch &batch,
                               Scratch &scratch) const = 0;
  /** Called with the new stress, the pressure included, and with what
      update_deviator() left in @p scratch. Writes `stiffening` where it is
      asked for and the law or the equation changes it. */
  virtual void after_pressure(const MaterialBatch &, const Scratch &) const {}

  /** s <- dev(s) + 2 G dev(D dt), the elastic trial, free of pressure: the
      first line of most laws. */
  void trial_deviator(const MaterialBatch &batch) const;

  const ElasticConstants constants;
  const Eos eos;  // never null
  const double G; // at rest [Pa]

private:
  void update_whole(const MaterialBatch &batch) const;

  const std::size_t n_eos_states; // arrays of state that are the equation's
};
} // namespace sabot

#endif
