// What all laws share: density, isotropic elasticity, and a deviator composed
// with an equation of state.
#include "sabot/materials/elastic_base.h"

#include "sabot/base/error.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/bulk_modulus.h"

#include <algorithm>
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

namespace
{
/** A batch of whole packs: the points of another, the last one again behind
    them. A compiler may fuse other products in loops' last turns than in whole
    registers; here no loop has such turns. */
class WholePacks
{
public:
  static constexpr std::size_t width = 8; // the widest pack's
  WholePacks(const MaterialBatch &batch, const std::size_t n_states)
      : whole(batch), n(batch.n)
  {
    whole.n = (n + width - 1) / width * width;
    data.reserve((n_rows + n_states) * whole.n); // rows do not move
    for (int c = 0; c < n_symmetric; ++c)
    {
      whole.stress[c] = copy(batch.stress[c]);
      whole.strain_increment[c] = copy(batch.strain_increment[c]);
    }
    for (int c = 0; c < 9; ++c)
      whole.deformation_gradient[c] = copy(batch.deformation_gradient[c]);
    whole.jacobian = copy(batch.jacobian);
    whole.extra_square = copy(batch.extra_square);
    whole.viscous_pressure = copy(batch.viscous_pressure);
    whole.return_factor = copy(batch.return_factor);
    whole.plastic_work = copy(batch.plastic_work);
    whole.stiffening = copy(batch.stiffening);
    for (std::size_t s = 0; s < n_states; ++s)
      states.push_back(copy(batch.states[s]));
    whole.states = states.data();
  }
  void copy_back(const MaterialBatch &batch) const
  {
    for (int c = 0; c < n_symmetric; ++c)
      std::copy_n(whole.stress[c], n, batch.stress[c]);
    for (std::size_t s = 0; s < states.size(); ++s)
      std::copy_n(states[s], n, batch.states[s]);
    std::copy_n(whole.return_factor, n, batch.return_factor);
    std::copy_n(whole.plastic_work, n, batch.plastic_work);
    if (batch.stiffening)
      std::copy_n(whole.stiffening, n, batch.stiffening);
  }

  MaterialBatch whole;

private:
  static constexpr std::size_t n_rows = 2 * n_symmetric + 9 + 6;
  double *copy(const double *const row)
  {
    if (row == nullptr)
      return nullptr;
    const std::size_t begin = data.size();
    data.insert(data.end(), row, row + n);
    data.resize(begin + whole.n, row[n - 1]);
    return &data[begin];
  }

  const std::size_t n;
  std::vector<double> data;
  std::vector<double *> states;
};
} // namespace

void ElasticBase::update(const MaterialBatch &batch) const
{
  if (batch.n == 0)
    return;
  if (batch.n % WholePacks::width == 0)
    return update_whole(batch);
  std::size_t n_states = 0;
  for (const StateVariable &variable : state_variables())
    n_states += variable.is_tensor ? n_symmetric : 1;
  WholePacks packs(batch, n_states);
  update_whole(packs.whole);
  packs.copy_back(batch);
}

void ElasticBase::update_whole(const MaterialBatch &batch) const
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
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    WidePack s[6], e[6];
    load_wide(b.stress, k, s);
    load_wide(b.strain_increment, k, e);
    make_deviator(s);
    make_deviator(e);
    for (int c = 0; c < 6; ++c)
      s[c] += 2. * G * e[c];
    store_wide(b.stress, k, s);
  }
}
} // namespace sabot
