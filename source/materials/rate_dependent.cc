// Entries of the laws that heat up.
#include "sabot/materials/rate_dependent.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"

namespace sabot
{
void ThermalParameters::declare_parameters(
    Parameters &prm, const std::string &initial_temperature)
{
  prm.declare_entry("Initial temperature", initial_temperature,
                    quantity(Dimension::temperature, 0., 1e4),
                    "Temperature at time 0.");
  prm.declare_entry("Specific heat", "1000 J/kg/K",
                    quantity(Dimension::specific_heat, 1., 1e6),
                    "At constant pressure.");
  prm.declare_entry("Taylor-Quinney fraction", "0.9",
                    quantity(Dimension::none, 0., 1.),
                    "Part of the plastic work that becomes heat; 0 switches "
                    "adiabatic heating off.");
  prm.declare_entry("Thermal conductivity", "0 W/m/K",
                    quantity(Dimension::conductivity, 0., 1e5),
                    "For FEM bodies with Heat conduction = true.");
  prm.declare_entry("Thermal expansion", "0 1/K",
                    quantity(Dimension::inverse_temperature, 0., 1e-2),
                    "Linear coefficient: the volume is free of pressure at "
                    "J = exp(3 alpha (T - initial temperature)).");
}

ThermalParameters ThermalParameters::parse(const Parameters &prm,
                                           const std::string &path,
                                           const EquationOfState &eos)
{
  const ThermalParameters p = {get_quantity(prm, "Initial temperature"),
                               get_quantity(prm, "Specific heat"),
                               get_quantity(prm, "Taylor-Quinney fraction"),
                               get_quantity(prm, "Thermal conductivity"),
                               get_quantity(prm, "Thermal expansion")};
  if (p.expansion > 0. && !eos.state_variables().empty())
    throw InputError(path + "/Thermal expansion",
                     "must be 0 with this equation of state, whose internal "
                     "energy expands the material already");
  return p;
}
} // namespace sabot
