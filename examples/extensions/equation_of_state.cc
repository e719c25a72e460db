// Adds the equation of state "Murnaghan": a bulk modulus that grows with the
// pressure, K(p) = K + n p, which integrates to
//
//   p = K/n (J^-n - 1),
//
// J the volume over the one at rest, K of the elastic constants (F. D.
// Murnaghan, The compressibility of media under extreme pressures, Proc. Natl.
// Acad. Sci. 30 (1944) 244; with n near 7 the form of Tait for water). To keep
// it, copy this file into source/materials. Scene: equation_of_state.prm.
#include "sabot/base/registry.h"
#include "sabot/materials/elastic_base.h"

#include <cmath>

namespace sabot
{
namespace
{
/** Without memory and heat: what a shock dissipates does not come back as
    pressure, so it is for weak shocks. No pole: p stays finite for J > 0, and
    never falls below -K/n. */
class Murnaghan : public EquationOfState
{
public:
  Murnaghan(const double K, const double n) : K(K), n(n) {}
  double bulk_modulus() const override { return K; }
  bool stiffens() const override { return true; }
  void finish(const MaterialBatch &b, const Start &,
              const double shear_modulus) const override
  {
    const double shear = 4. / 3. * shear_modulus;
    for (std::size_t k = 0; k < b.n; ++k)
    {
      const double power = std::pow(b.jacobian[k], -n),
                   pressure = K / n * (power - 1.);
      for (int c = 0; c < 3; ++c)
        b.stress[c][k] -= pressure;
      if (b.stiffening) // K(p) = K J^-n, for the stable step
        b.stiffening[k] = (K * power + shear) / (K + shear);
    }
  }

private:
  const double K; // at rest [Pa]
  const double n; // dK/dp
};

constexpr const char *entry = "Pressure derivative";

const Registry<EquationOfState>::Add registered(
    {"Murnaghan", "bulk modulus of the elastic constants plus n times p.",
     [](Parameters &prm)
     {
       prm.declare_entry(entry, "4", quantity(Dimension::none, 0.1, 20.),
                         "n, of the bulk modulus: about 4 for metals, 7 for "
                         "water.");
     },
     [](const Parameters &prm, const std::string &,
        const ElasticConstants &elastic, std::vector<std::string> &)
     {
       return std::make_shared<Murnaghan>(elastic.bulk_modulus(),
                                          get_quantity(prm, entry));
     }});
} // namespace
} // namespace sabot
