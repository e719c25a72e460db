#ifndef sabot_base_quantity_h
#define sabot_base_quantity_h

#include "sabot/base/dimension.h"

#include <deal.II/base/parameter_handler.h>

#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/**
 * deal.II's pattern of a number with an optional unit ("12.7 mm", "324 MPa",
 * "1e-4"); a number alone is in SI units. Refuses other dimensions, what is not
 * finite, and values outside [min, max] (SI, inclusive); its description names
 * the range and the units it takes. Models use quantity() of parameters.h,
 * which needs no deal.II.
 */
class QuantityPattern : public dealii::Patterns::PatternBase
{
public:
  /** From here on a bound is none. */
  static constexpr double infinity = 1e300;

  /** One quantity. */
  QuantityPattern(const Dimension dimension, const double min = -infinity,
                  const double max = infinity);
  /** A comma-separated list of @p n_min to @p n_max quantities. */
  QuantityPattern(const Dimension dimension, const unsigned int n_min,
                  const unsigned int n_max, const double min, const double max);

  bool match(const std::string &text) const override;
  /** "a length from 0 to 1 m (units m, cm, ...; a number alone is in m)",
      whatever the @p style. */
  std::string description(const OutputStyle style = Machine) const override;
  std::unique_ptr<PatternBase> clone() const override;

private:
  Dimension dimension;
  unsigned int n_min = 1, n_max = 1;
  double min, max; // SI
};

/** SI value of a number with an optional unit of any dimension;
    std::invalid_argument for any other text. */
double to_si(const std::string &text);
/** Dimension of the unit @p name ("MPa"); nothing where it is no unit. */
std::optional<Dimension> dimension_of_unit(const std::string &name);
/** Parts between commas, trimmed; what follows a last comma counts, though
    empty, so that "1, 2," has three and is refused where two are asked. */
std::vector<std::string> split_at_commas(const std::string &text);
} // namespace sabot

#endif
