// Entries of critical values: a number, or the word "never".
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include "sabot/base/parameters.h"

namespace sabot
{
namespace
{
void declare(Parameters &prm, const std::string &name,
             const std::string &meaning, const Dimension dimension)
{
  prm.declare_entry(name, "never", word_or("never", quantity(dimension, 0.)),
                    meaning);
}
} // namespace

void declare_critical_stress(Parameters &prm, const std::string &name,
                             const std::string &meaning)
{
  declare(prm, name, meaning, Dimension::pressure);
}

void declare_critical_strain(Parameters &prm, const std::string &name,
                             const std::string &meaning)
{
  declare(prm, name, meaning, Dimension::none);
}

std::optional<double> critical_value(const Parameters &prm,
                                     const std::string &name,
                                     const double never)
{
  const std::optional<double> value = get_optional_quantity(prm, name);
  return value && *value < never ? value : std::nullopt;
}
} // namespace sabot
