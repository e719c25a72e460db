// What all laws share: density, isotropic elasticity, and a deviator composed
// with an equation of state.
#include "sabot/materials/elastic_base.h"

#include "sabot/base/error.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/materials/bulk_modulus.h"

#include <cmath>

namespace sabot
{
namespace
{
// States that several laws have.
const DescribeField described[] = {
    DescribeField({"effective plastic strain", "1", 1,
                   "cells, particles of laws that yield",
                   "Integral of sqrt(2/3 d_p:d_p) over time."}),
    DescribeField({"temperature", "K", 1,
                   "cells, particles of laws that heat up",
                   "Adiabatic, or with conduction where the body conducts."})};
} // namespace

void ElasticConstants::declare_parameters(Parameters &prm)
{
  prm.declare_entry("Density", "0", quantity(Dimension::density, 0., 1e5),
                    "Density of the stress-free material.");
  prm.declare_entry("Young's modulus", "0",
                    quantity(Dimension::pressure, 0., 1e13),
                    "Modulus in uniaxial stress.");
  prm.declare_entry("Poisson's ratio", "0.3",
                    quantity(Dimension::none, -0.99, 0.49999), "Below 0.5.");
}

ElasticConstants ElasticConstants::parse(const Parameters &prm,
                                         const std::string &path)
{
  ElasticConstants c;
  c.density = get_quantity(prm, "Density");
  c.young_modulus = get_quantity(prm, "Young's modulus");
  c.poisson_ratio = get_quantity(prm, "Poisson's ratio");
  if (c.density <= 0.)
    throw InputError(path + "/Density", "must be set to a positive density, "
                                        "for example 2700 kg/m^3");
  if (c.young_modulus <= 0.)
    throw InputError(path + "/Young's modulus",
                     "must be set to a positive modulus, for example 70 GPa");
  const double speed =
      std::sqrt((c.bulk_modulus() + 4. / 3. * c.shear_modulus()) / c.density);
  if (speed < 100. || speed > 20000.)
    throw InputError(path + "/Density",
                     "density " + prm.get("Density") + " and Young's modulus " +
                         prm.get("Young's modulus") +
                         " give a sound speed of " +
                         formatted("%.4g m/s", speed) +
                         "; expected 100 to 20000 m/s: check the units of "
                         "both (a number alone is in kg/m^3 or Pa)");
  return c;
}

ElasticBase::ElasticBase(const ElasticConstants &c, const Eos &eos)
    : constants(c),
      eos(eos ? eos : std::make_shared<BulkModulus>(c.bulk_modulus())),
      G(c.shear_modulus()), n_eos_states(this->eos->state_variables().size())
{
}

std::vector<StateVariable> ElasticBase::state_variables() const
{
  std::vector<StateVariable> variables = eos->state_variables();
  for (const StateVariable &variable : law_variables())
    variables.push_back(variable);
  return variables;
}

void ElasticBase::update(const MaterialBatch &batch) const
{
  EquationOfState::Start start;
  eos->begin(batch, start);
  MaterialBatch law = batch;
  law.states = batch.states + n_eos_states;
  Scratch scratch;
  update_deviator(law, scratch);
  eos->finish(batch, start, G);
  after_pressure(law, scratch);
}

void ElasticBase::trial_deviator(const MaterialBatch &b) const
{
  const double two_G = 2. * G;
  double *const *const s = b.stress;
  const double *const *const e = b.strain_increment;
#pragma GCC ivdep // arrays do not overlap
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double trace = (e[0][k] + e[1][k] + e[2][k]) / 3.;
    const double mean = (s[0][k] + s[1][k] + s[2][k]) / 3.;
    for (int c = 0; c < 3; ++c)
      s[c][k] += two_G * (e[c][k] - trace) - mean;
    for (int c = 3; c < 6; ++c)
      s[c][k] += two_G * e[c][k];
  }
}
} // namespace sabot
