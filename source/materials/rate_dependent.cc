#include "sabot/materials/rate_dependent.h"

#include "sabot/base/quantity.h"

namespace sabot
{
void ThermalParameters::declare_parameters(
    dealii::ParameterHandler &prm, const std::string &initial_temperature)
{
  prm.declare_entry("Initial temperature", initial_temperature,
                    QuantityPattern(Dimension::temperature, 0., 1e4),
                    "Temperature at time 0.");
  prm.declare_entry("Specific heat", "1000 J/kg/K",
                    QuantityPattern(Dimension::specific_heat, 1., 1e6),
                    "At constant pressure.");
  prm.declare_entry("Taylor-Quinney fraction", "0.9",
                    QuantityPattern(Dimension::none, 0., 1.),
                    "Part of the plastic work that becomes heat; 0 switches "
                    "adiabatic heating off.");
}

ThermalParameters ThermalParameters::parse(const dealii::ParameterHandler &prm)
{
  return {get_quantity(prm, "Initial temperature"),
          get_quantity(prm, "Specific heat"),
          get_quantity(prm, "Taylor-Quinney fraction")};
}
} // namespace sabot
