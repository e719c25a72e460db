#ifndef sabot_base_dimension_h
#define sabot_base_dimension_h

namespace sabot
{
/**
 * Dimensions of the quantities in scene files. Each has a unit of the SI, in
 * which the program calculates throughout, and may have others, which
 * source/base/quantity.cc lists: a new unit is one line there, a new dimension
 * one here and two there. A quantity of one dimension is refused where another
 * is asked for, so that "12.7 kg" is no length.
 */
enum class Dimension
{
  none,         // a pure number: strains, fractions, exponents
  length,       // [m]
  time,         // [s]
  velocity,     // [m/s]
  acceleration, // [m/s^2]
  mass,         // [kg]
  density,      // [kg/m^3]
  pressure,     // [Pa]; also stresses and moduli
  // Absolute, not a difference: 20 degrees of Celsius are no quantity.
  temperature,         // [K]
  specific_heat,       // [J/kg/K]
  strain_rate,         // [1/s]
  energy,              // [J]
  angle,               // [rad]
  inverse_temperature, // [1/K], of expansion and softening
  inverse_pressure,    // [1/Pa]
  conductivity         // [W/m/K]
};
} // namespace sabot

#endif
