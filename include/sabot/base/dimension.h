#ifndef sabot_base_dimension_h
#define sabot_base_dimension_h

namespace sabot
{
/** Dimensions of the quantities in scene files. */
enum class Dimension
{
  none,
  length,
  time,
  velocity,
  mass,
  density,
  pressure,
  temperature,
  specific_heat,
  strain_rate,
  energy,
  angle,
  inverse_temperature,
  inverse_pressure,
  conductivity
};
} // namespace sabot

#endif
