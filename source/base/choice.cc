// Choices from registries without a file, and entries that have no effect.
#include "sabot/base/choice.h"

#include <cstdio>

namespace sabot
{
std::string exact_text(const double value)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

bool same_value(const std::string &text, const std::string &standard)
{
  if (text == standard)
    return true;
  const std::optional<double> number = read_quantity(text);
  if (!number)
    return false;
  if (standard == "never")
    return *number >= 1e10;
  const std::optional<double> expected = read_quantity(standard);
  return expected && *number == *expected;
}
} // namespace sabot
