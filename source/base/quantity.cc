// Quantities of scene files: numbers with units, and what an entry accepts.
#include "sabot/base/quantity.h"

#include "sabot/base/text.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace sabot
{
namespace
{
struct Unit
{
  Dimension dimension;
  const char *name;
  double in_si;
};

// The first unit of each dimension is SI.
const Unit units[] = {
    {Dimension::length, "m", 1.},
    {Dimension::length, "cm", 1e-2},
    {Dimension::length, "mm", 1e-3},
    {Dimension::length, "um", 1e-6},
    {Dimension::length, "km", 1e3},
    {Dimension::time, "s", 1.},
    {Dimension::time, "ms", 1e-3},
    {Dimension::time, "us", 1e-6},
    {Dimension::time, "ns", 1e-9},
    {Dimension::velocity, "m/s", 1.},
    {Dimension::velocity, "km/s", 1e3},
    {Dimension::velocity, "mm/us", 1e3},
    {Dimension::acceleration, "m/s^2", 1.},
    {Dimension::acceleration, "km/s^2", 1e3},
    {Dimension::acceleration, "mm/us^2", 1e9},
    {Dimension::mass, "kg", 1.},
    {Dimension::mass, "g", 1e-3},
    {Dimension::density, "kg/m^3", 1.},
    {Dimension::density, "g/cm^3", 1e3},
    {Dimension::pressure, "Pa", 1.},
    {Dimension::pressure, "kPa", 1e3},
    {Dimension::pressure, "MPa", 1e6},
    {Dimension::pressure, "GPa", 1e9},
    {Dimension::temperature, "K", 1.},
    {Dimension::specific_heat, "J/kg/K", 1.},
    {Dimension::specific_heat, "kJ/kg/K", 1e3},
    {Dimension::strain_rate, "1/s", 1.},
    {Dimension::strain_rate, "1/ms", 1e3},
    {Dimension::energy, "J", 1.},
    {Dimension::energy, "kJ", 1e3},
    {Dimension::angle, "rad", 1.},
    {Dimension::angle, "deg", 0.017453292519943295},
    {Dimension::inverse_temperature, "1/K", 1.},
    {Dimension::inverse_pressure, "1/Pa", 1.},
    {Dimension::inverse_pressure, "1/GPa", 1e-9},
    {Dimension::conductivity, "W/m/K", 1.},
};

const char *dimension_name(const Dimension dimension)
{
  switch (dimension)
  {
  case Dimension::none:
    return "a pure number";
  case Dimension::length:
    return "a length";
  case Dimension::time:
    return "a time";
  case Dimension::velocity:
    return "a velocity";
  case Dimension::acceleration:
    return "an acceleration";
  case Dimension::mass:
    return "a mass";
  case Dimension::density:
    return "a density";
  case Dimension::pressure:
    return "a stress";
  case Dimension::temperature:
    return "a temperature";
  case Dimension::specific_heat:
    return "a specific heat";
  case Dimension::strain_rate:
    return "a strain rate";
  case Dimension::energy:
    return "an energy";
  case Dimension::angle:
    return "an angle";
  case Dimension::inverse_temperature:
    return "an inverse temperature";
  case Dimension::inverse_pressure:
    return "an inverse stress";
  case Dimension::conductivity:
    return "a thermal conductivity";
  }
  return "";
}

/** @p text with the minus of typographers, micro signs and raised digits as a
    keyboard has them. */
std::string plain(std::string text)
{
  const char *const signs[][2] = {{"\u2212", "-"},
                                  {"\u00b5", "u"},
                                  {"\u03bc", "u"},
                                  {"\u00b2", "^2"},
                                  {"\u00b3", "^3"}};
  for (const auto &[sign, key] : signs)
    text = replaced(std::move(text), sign, key);
  return text;
}

/** Number and unit; false when the text is no finite number. */
bool read_number(const std::string &given, double &number, std::string &unit)
{
  const std::string text = plain(given);
  char *end;
  number = std::strtod(text.c_str(), &end);
  // strtod takes hexadecimal numbers, too.
  if (end == text.c_str() || !std::isfinite(number) ||
      text.substr(0, end - text.c_str()).find_first_of("xX") !=
          std::string::npos)
    return false;
  unit = trim(end);
  return true;
}

const Unit *find_unit(const std::string &name)
{
  for (const Unit &unit : units)
    if (name == unit.name)
      return &unit;
  return nullptr;
}

std::string short_number(const double value)
{
  std::ostringstream stream;
  stream << value;
  return stream.str();
}
} // namespace

std::vector<std::string> split_at_commas(const std::string &text)
{
  std::vector<std::string> items = split(text, ',');
  if (!text.empty() && text.back() == ',')
    items.push_back("");
  return items;
}

double to_si(const std::string &text)
{
  double number;
  std::string unit_name;
  if (!read_number(text, number, unit_name))
    throw std::invalid_argument("not a quantity: \"" + text + "\"");
  if (unit_name.empty())
    return number;
  const Unit *unit = find_unit(unit_name);
  if (unit == nullptr)
    throw std::invalid_argument("unknown unit in \"" + text + "\"");
  return number * unit->in_si;
}

std::optional<Dimension> dimension_of_unit(const std::string &name)
{
  const Unit *const unit = find_unit(name);
  return unit == nullptr ? std::nullopt
                         : std::optional<Dimension>(unit->dimension);
}

QuantityPattern::QuantityPattern(const Dimension dimension, const double min,
                                 const double max)
    : dimension(dimension), min(min), max(max)
{
}

QuantityPattern::QuantityPattern(const Dimension dimension,
                                 const unsigned int n_min,
                                 const unsigned int n_max, const double min,
                                 const double max)
    : dimension(dimension), n_min(n_min), n_max(n_max), min(min), max(max)
{
}

bool QuantityPattern::match(const std::string &text) const
{
  const std::vector<std::string> items = split_at_commas(text);
  if (items.size() < n_min || items.size() > n_max)
    return false;
  bool has_units = false, lacks_units = false;
  for (const std::string &item : items)
  {
    double number;
    std::string unit_name;
    if (!read_number(item, number, unit_name))
      return false;
    has_units = has_units || !unit_name.empty();
    lacks_units = lacks_units || (unit_name.empty() && number != 0.);
    if (!unit_name.empty())
    {
      const Unit *unit = find_unit(unit_name);
      if (unit == nullptr || unit->dimension != dimension)
        return false;
      number *= unit->in_si;
    }
    if (number < min || number > max)
      return false;
  }
  // "4, 4, 4 mm" is no plate of 4 m.
  return !(has_units && lacks_units);
}

std::string QuantityPattern::description(const OutputStyle) const
{
  std::string text;
  if (n_max > 1)
    text = (n_min == n_max
                ? std::to_string(n_min)
                : std::to_string(n_min) + " to " + std::to_string(n_max)) +
           " values separated by commas, each ";
  text += dimension_name(dimension);
  std::string si, names;
  for (const Unit &unit : units)
    if (unit.dimension == dimension)
    {
      if (si.empty())
        si = unit.name;
      names += (names.empty() ? "" : ", ") + std::string(unit.name);
    }
  const std::string suffix = si.empty() ? "" : " " + si;
  if (min > -infinity && max < infinity)
    text += " from " + short_number(min) + " to " + short_number(max) + suffix;
  else if (min > -infinity)
    text += " of at least " + short_number(min) + suffix;
  else if (max < infinity)
    text += " of at most " + short_number(max) + suffix;
  if (!si.empty())
    text += " (units " + names + "; a number alone is in " + si + ")";
  return text;
}

std::unique_ptr<dealii::Patterns::PatternBase> QuantityPattern::clone() const
{
  return std::make_unique<QuantityPattern>(*this);
}

} // namespace sabot
