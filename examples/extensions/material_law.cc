// Adds the material law "Voce": J2 plasticity whose hardening saturates,
//
//   Y(eps) = Y_0 + Q (1 - exp(-b eps)),
//
// eps the effective plastic strain (E. Voce, The relationship between stress
// and strain for homogeneous deformation, J. Inst. Metals 74 (1948) 537). To
// keep it, copy this file into source/materials. Scene: material_law.prm.
#include "sabot/base/registry.h"
#include "sabot/materials/elastic_base.h"

#include <cmath>

namespace sabot
{
namespace
{
struct VoceParameters
{
  double yield_stress = 0.; // Y_0 [Pa]
  double saturation = 0.;   // Q [Pa]
  double rate = 0.;         // b
};

void declare(Parameters &prm)
{
  prm.declare_entry("Yield stress", "0",
                    quantity(Dimension::pressure, 0., 1e12),
                    "Y0, where it first yields.");
  prm.declare_entry("Saturation stress", "0",
                    quantity(Dimension::pressure, 0., 1e12),
                    "Q, what hardening adds to it in the end.");
  prm.declare_entry("Saturation rate", "10", quantity(Dimension::none, 0., 1e4),
                    "b: after a plastic strain of 1/b hardening has added 63 % "
                    "of Q.");
}

VoceParameters parse(const Parameters &prm, const std::string &path)
{
  VoceParameters p;
  p.yield_stress = get_quantity(prm, "Yield stress");
  p.saturation = get_quantity(prm, "Saturation stress");
  p.rate = get_quantity(prm, "Saturation rate");
  if (p.yield_stress <= 0.)
    throw InputError(path + "/Yield stress",
                     "must be set to a positive stress, for example 250 MPa");
  return p;
}

/** Radial return (J. C. Simo and T. J. R. Hughes, Computational Inelasticity,
    1998, box 3.1): the increment d of eps is the root of q - 3 G d - Y(eps + d)
    with the trial q, and the deviator is scaled by 1 - 3 G d/q. No effect of
    rate or temperature. */
class Voce : public ElasticBase
{
public:
  Voce(const ElasticConstants &elastic, const VoceParameters &p, const Eos &eos)
      : ElasticBase(elastic, eos), p(p)
  {
  }
  std::optional<double> initial_yield_stress() const override
  {
    return p.yield_stress;
  }

protected:
  std::vector<StateVariable> law_variables() const override
  {
    return {{"effective plastic strain"}};
  }
  void update_deviator(const MaterialBatch &b, Scratch &) const override
  {
    trial_deviator(b);
    double *const eps = b.state(0);
    for (std::size_t k = 0; k < b.n; ++k)
    {
      double square = b.extra_square[k]; // yields with the stress
      for (int c = 0; c < 6; ++c)
        square += (c < 3 ? 1.5 : 3.) * b.stress[c][k] * b.stress[c][k];
      const double q = std::sqrt(square), d = increment(q, eps[k]),
                   theta = d > 0. ? 1. - 3. * G * d / q : 1.;
      for (int c = 0; c < 6; ++c)
        b.stress[c][k] *= theta;
      eps[k] += d;
      b.return_factor[k] = theta;
      b.plastic_work[k] = theta * q * d;
    }
  }

private:
  double hardening(const double eps) const // what is left of Q
  {
    return p.saturation * std::exp(-p.rate * eps);
  }
  /** The root d, 0 where the step is elastic. Newton from 0 rises to it and
      never passes it: q - 3 G d - Y is convex, as Y is concave. */
  double increment(const double q, const double eps) const
  {
    double d = 0.;
    for (int iteration = 0; iteration < 50; ++iteration)
    {
      const double left = hardening(eps + d),
                   f = q - 3. * G * d - (p.yield_stress + p.saturation - left);
      if (f <= 1e-13 * q)
        break;
      d += f / (3. * G + p.rate * left);
    }
    return d;
  }

  const VoceParameters p;
};

const Registry<Material>::Add registered(
    {"Voce", "J2 plasticity whose isotropic hardening saturates.", declare,
     [](const Parameters &prm, const std::string &path,
        const ElasticConstants &elastic, const ElasticBase::Eos &eos)
     { return std::make_unique<Voce>(elastic, parse(prm, path), eos); }});
} // namespace
} // namespace sabot
