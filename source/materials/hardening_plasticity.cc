#include "sabot/base/error.h"
#include "sabot/base/quantity.h"
#include "sabot/materials/laws.h"

#include <cmath>

namespace sabot
{
std::vector<StateVariable> HardeningPlasticity::state_variables() const
{
  std::vector<StateVariable> variables = {
      {"effective plastic strain", "1", 0., false}};
  if (parameters.isotropic_fraction < 1.)
    variables.push_back({"back stress", "Pa", 0., true});
  return variables;
}

void HardeningPlasticity::update(const MaterialBatch &b) const
{
  trial_stress(b);
  const bool kinematic = parameters.isotropic_fraction < 1.;
  const double H = parameters.hardening_modulus,
               isotropic = parameters.isotropic_fraction * H,
               moving = H - isotropic;
  double *const eps = b.state(0);
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double mean = (b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
    double xi[6]; // deviator relative to the back stress
    for (int c = 0; c < 6; ++c)
      xi[c] = b.stress[c][k] - (c < 3 ? mean : 0.) -
              (kinematic ? b.state(1 + c)[k] : 0.);
    const double q =
        std::sqrt(1.5 * (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2] +
                         2. * (xi[3] * xi[3] + xi[4] * xi[4] + xi[5] * xi[5])) +
                  b.extra_square[k]);
    const double excess = q - parameters.yield_stress - isotropic * eps[k];
    const double increment = excess > 0. ? excess / (3. * G + H) : 0.;
    const double scale = increment > 0. ? 1.5 * increment / q : 0.;
    // Plastic work with the stress at the end of the step.
    double work = 0.;
    for (int c = 0; c < 6; ++c)
    {
      b.stress[c][k] -= 2. * G * scale * xi[c];
      if (kinematic)
        b.state(1 + c)[k] += 2. / 3. * moving * scale * xi[c];
      work += (c < 3 ? 1. : 2.) * b.stress[c][k] * scale * xi[c];
    }
    eps[k] += increment;
    b.plastic_work[k] = work;
    b.return_factor[k] = increment > 0. ? 1. - 3. * G * increment / q : 1.;
  }
}

namespace
{
const RegisterMaterial registered(
    {"Hardening plasticity",
     "J2 plasticity with linear isotropic, kinematic or mixed hardening.",
     [](dealii::ParameterHandler &prm)
     {
       prm.declare_entry("Yield stress", "0",
                         QuantityPattern(Dimension::pressure, 0., 1e12),
                         "Initial yield stress.");
       prm.declare_entry("Hardening modulus", "0",
                         QuantityPattern(Dimension::pressure, 0., 1e12),
                         "Slope of stress against plastic strain.");
       prm.declare_entry("Isotropic fraction", "1",
                         QuantityPattern(Dimension::none, 0., 1.),
                         "1: isotropic hardening, 0: kinematic.");
     },
     [](dealii::ParameterHandler &prm, const std::string &path)
     {
       const ElasticConstants elastic = ElasticConstants::parse(prm, path);
       prm.enter_subsection("Hardening plasticity");
       HardeningParameters p;
       p.yield_stress = get_quantity(prm, "Yield stress");
       p.hardening_modulus = get_quantity(prm, "Hardening modulus");
       p.isotropic_fraction = get_quantity(prm, "Isotropic fraction");
       prm.leave_subsection();
       if (p.yield_stress <= 0.)
         throw InputError(path + "/Hardening plasticity/Yield stress",
                          "must be set to a positive stress, for example "
                          "324 MPa");
       return std::make_unique<HardeningPlasticity>(elastic, p);
     }});
} // namespace
} // namespace sabot
