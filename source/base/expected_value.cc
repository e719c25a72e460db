// What an entry expects, as messages say it of a value that it does not accept.
#include "sabot/base/expected_value.h"

#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace sabot
{
namespace
{
bool is_digit(const char c)
{
  return std::isdigit(static_cast<unsigned char>(c));
}

/** deal.II's description of a pattern as a sentence goes on. */
std::string in_words(const std::string &pattern)
{
  if (pattern == "[Bool]")
    return "true or false";
  const std::string range = "[Integer range ";
  if (pattern.compare(0, range.size(), range) != 0)
    return pattern;
  const std::string bounds = pattern.substr(
      range.size(), pattern.find(' ', range.size()) - range.size());
  const std::size_t dots = bounds.find("...");
  const std::string low = bounds.substr(0, dots),
                    high = bounds.substr(dots + 3);
  return "a whole number " + (high == "2147483647"
                                  ? "of at least " + low
                                  : "from " + low + " to " + high);
}

/** Whether of the numbers in the list @p value some have a unit and others,
    which are not zero, have none. */
bool mixes_units(const std::string &value)
{
  bool has_units = false, lacks_units = false;
  for (const std::string &item : split(value, ','))
  {
    const std::string text = trim(item);
    const std::optional<double> number = read_quantity(text);
    if (!number)
      return false;
    const bool is_alone = is_digit(text.back()) || text.back() == '.';
    has_units = has_units || !is_alone;
    lacks_units = lacks_units || (is_alone && *number != 0.);
  }
  return has_units && lacks_units;
}

/** What stands behind the last number of @p value, also without a blank between
    them. */
std::string last_unit(const std::string &value)
{
  const std::string last = value.substr(value.find_last_of(" ,") + 1);
  char *end = nullptr;
  std::strtod(last.c_str(), &end);
  return end;
}

/** A unit as people write it elsewhere: other cases, longer words for s. */
bool means_unit(const std::string &word, const std::string &unit)
{
  const std::string lower = lower_case(word);
  return lower_case(unit) == lower.substr(0, lower.find("sec") + 1) ||
         lower_case(unit) == lower;
}

/** What to write instead of a value as people write it elsewhere. */
std::string advice(const std::string &pattern, const std::string &value)
{
  const bool is_one = pattern.find("separated by commas") == std::string::npos;
  const std::size_t comma = value.find(',');
  if (is_one && comma != std::string::npos && comma > 0 &&
      comma + 1 < value.size() && is_digit(value[comma - 1]) &&
      is_digit(value[comma + 1]))
    return "; write the decimals behind a point, as in " +
           replaced(value, ",", ".");
  if (!is_one && mixes_units(value))
    return "; some numbers have a unit and others none: give each its own";
  const std::string word = last_unit(value), mark = "(units ";
  const std::size_t units = pattern.find(mark);
  if (units != std::string::npos && !word.empty())
    for (const std::string &unit :
         split(pattern.substr(units + mark.size(),
                              pattern.find(';', units) - units - mark.size()),
               ','))
      if (unit != word && means_unit(word, unit))
        return "; did you mean the unit " + unit + "?";
  if (!value.empty() && value.back() == '%')
    return "; write a share of 1, as in 0.3 for 30 %";
  if (value.find_first_of("*/()^") != std::string::npos && is_digit(value[0]) &&
      read_quantity(value.substr(0, value.find_first_of("*/()^ "))))
    return "; formulas are not worked out, write the number";
  return "";
}
} // namespace

std::string expected_value(std::string pattern, const std::string &value)
{
  const std::string selection = "[Selection ";
  if (pattern.compare(0, selection.size(), selection) == 0)
  {
    const std::vector<std::string> words = split(
        pattern.substr(selection.size(), pattern.size() - selection.size() - 2),
        '|');
    return "one of " + join(words, ", ") + suggestion(value, words);
  }
  std::replace(pattern.begin(), pattern.end(), '|', ' ');
  return in_words(pattern) + advice(pattern, value);
}
} // namespace sabot
