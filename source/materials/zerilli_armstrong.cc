// Flow stress after Zerilli and Armstrong, for both lattices.
#include "sabot/materials/zerilli_armstrong.h"

#include "sabot/base/registry.h"

namespace sabot
{
namespace
{
template <bool bcc>
void declare(Parameters &prm)
{
  const auto entry = [&](const std::string &name, const std::string &value,
                         const Dimension d, const double low, const double high,
                         const std::string &text)
  { prm.declare_entry(name, value, quantity(d, low, high), text); };
  entry("C0", "0", Dimension::pressure, 0., 1e12,
        "Athermal stress, grain size included.");
  entry(bcc ? "C1" : "C2", "0", Dimension::pressure, 0., 1e12,
        bcc ? "Thermal stress." : "Thermal stress at strain 1.");
  entry("C3", "0", Dimension::inverse_temperature, 0., 1.,
        "Thermal softening.");
  entry("C4", "0", Dimension::inverse_temperature, 0., 1., "Rate effect.");
  if (bcc)
  {
    entry("C5", "0", Dimension::pressure, 0., 1e12, "Hardening.");
    entry("Hardening exponent", "1", Dimension::none, 0.001, 5., "n.");
  }
  entry("Melt temperature", "1e5 K", Dimension::temperature, 1., 1e5,
        "Temperature at which the strength is gone.");
  ThermalParameters::declare_parameters(prm, "294 K");
}

template <bool bcc>
std::unique_ptr<Material> make(const Parameters &prm, const std::string &path,
                               const ElasticConstants &elastic,
                               const ElasticBase::Eos &eos)
{
  ZerilliArmstrongParameters p;
  p.C0 = get_quantity(prm, "C0");
  (bcc ? p.C1 : p.C2) = get_quantity(prm, bcc ? "C1" : "C2");
  p.C3 = get_quantity(prm, "C3");
  p.C4 = get_quantity(prm, "C4");
  if (bcc)
  {
    p.C5 = get_quantity(prm, "C5");
    p.n = get_quantity(prm, "Hardening exponent");
  }
  p.melt_temperature = get_quantity(prm, "Melt temperature");
  const ThermalParameters thermal = ThermalParameters::parse(prm, path, *eos);
  if (p.C0 <= 0.)
    throw InputError(path + "/C0",
                     "must be set to a positive stress, for example 65 MPa");
  return std::make_unique<RateDependentPlasticity<ZerilliArmstrongFlow<bcc>>>(
      elastic, ZerilliArmstrongFlow<bcc>{p}, thermal, eos);
}

const Registry<Material>::Add
    registered_fcc({"Zerilli-Armstrong fcc",
                    "dislocation mechanics of face-centered cubic metals.",
                    declare<false>, make<false>});
const Registry<Material>::Add
    registered_bcc({"Zerilli-Armstrong bcc",
                    "dislocation mechanics of body-centered cubic metals.",
                    declare<true>, make<true>});
} // namespace
} // namespace sabot
