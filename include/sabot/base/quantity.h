#ifndef sabot_base_quantity_h
#define sabot_base_quantity_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

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

/**
 * Pattern of a number with an optional unit ("12.7 mm", "324 MPa", "1e-4"); a
 * number alone is in SI units. Refuses other dimensions and values outside
 * [min, max] (SI); its description names the range and the units it takes.
 */
class QuantityPattern : public dealii::Patterns::PatternBase
{
public:
  static constexpr double infinity = 1e300;

  QuantityPattern(const Dimension dimension, const double min = -infinity,
                  const double max = infinity);
  /** A comma-separated list of @p n_min to @p n_max quantities. */
  QuantityPattern(const Dimension dimension, const unsigned int n_min,
                  const unsigned int n_max, const double min, const double max);

  bool match(const std::string &text) const override;
  std::string description(const OutputStyle style = Machine) const override;
  std::unique_ptr<PatternBase> clone() const override;

private:
  Dimension dimension;
  unsigned int n_min = 1, n_max = 1;
  double min, max;
};

/** Value in SI units of the current subsection's entry @p name, declared with
    a QuantityPattern. */
double get_quantity(const dealii::ParameterHandler &prm,
                    const std::string &name);
std::vector<double> get_quantities(const dealii::ParameterHandler &prm,
                                   const std::string &name);
/** Entries of a comma-separated list of names, trimmed, empty ones dropped. */
std::vector<std::string> split_names(const std::string &text);
} // namespace sabot

#endif
