// Strength and shear modulus after Steinberg, Cochran and Guinan.
#include "sabot/materials/steinberg_guinan.h"

#include "sabot/base/registry.h"

namespace sabot
{
namespace
{
void declare(Parameters &prm)
{
  const auto entry = [&](const std::string &name, const std::string &value,
                         const Dimension d, const double low, const double high,
                         const std::string &text)
  { prm.declare_entry(name, value, quantity(d, low, high), text); };
  entry("Initial yield stress", "0", Dimension::pressure, 0., 1e12, "Y0.");
  entry("Largest yield stress", "0", Dimension::pressure, 0., 1e12,
        "Ymax, at zero pressure and reference temperature.");
  entry("Hardening coefficient", "0", Dimension::none, 0., 1e5, "beta.");
  entry("Hardening exponent", "0", Dimension::none, 0., 5., "n.");
  entry("Initial plastic strain", "0", Dimension::none, 0., 10., "eps_i.");
  entry("Pressure coefficient", "0", Dimension::inverse_pressure, 0., 1e-6,
        "A = (dG/dp)/G0.");
  entry("Temperature coefficient", "0", Dimension::inverse_temperature, 0., 1.,
        "B = -(dG/dT)/G0.");
  entry("Reference temperature", "300 K", Dimension::temperature, 0., 1e4,
        "Temperature of the shear modulus.");
  entry("Melt temperature", "1000 K", Dimension::temperature, 1., 1e5,
        "Tm0, at the initial density.");
  entry("Melt Gruneisen coefficient", "2", Dimension::none, 0., 10.,
        "gamma0 of the melting law.");
  entry("Melt volume correction", "1.5", Dimension::none, -10., 10.,
        "a of the melting law.");
  ThermalParameters::declare_parameters(prm, "300 K");
}

std::unique_ptr<Material> make(const Parameters &prm, const std::string &path,
                               const ElasticConstants &elastic,
                               const ElasticBase::Eos &eos)
{
  SteinbergGuinanParameters p;
  p.yield_stress = get_quantity(prm, "Initial yield stress");
  p.largest_yield_stress = get_quantity(prm, "Largest yield stress");
  p.beta = get_quantity(prm, "Hardening coefficient");
  p.n = get_quantity(prm, "Hardening exponent");
  p.initial_plastic_strain = get_quantity(prm, "Initial plastic strain");
  p.pressure_coefficient = get_quantity(prm, "Pressure coefficient");
  p.temperature_coefficient = get_quantity(prm, "Temperature coefficient");
  p.reference_temperature = get_quantity(prm, "Reference temperature");
  p.melt_temperature = get_quantity(prm, "Melt temperature");
  p.gruneisen = get_quantity(prm, "Melt Gruneisen coefficient");
  p.melt_correction = get_quantity(prm, "Melt volume correction");
  const ThermalParameters thermal = ThermalParameters::parse(prm, path, *eos);
  if (p.yield_stress <= 0.)
    throw InputError(path + "/Initial yield stress",
                     "must be set to a positive stress, for example 290 MPa");
  if (p.largest_yield_stress < p.yield_stress)
    throw InputError(path + "/Largest yield stress",
                     "must be at least the initial yield stress");
  return std::make_unique<SteinbergGuinan>(elastic, SteinbergGuinanFlow{p},
                                           thermal, eos);
}

const Registry<Material>::Add
    registered({"Steinberg-Guinan",
                "strength and shear modulus grow with pressure and fall with "
                "temperature, for rates above 1e5 1/s.",
                declare, make});
} // namespace
} // namespace sabot
