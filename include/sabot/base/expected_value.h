#ifndef sabot_base_expected_value_h
#define sabot_base_expected_value_h

#include <string>

namespace sabot
{
/**
 * What an entry expects that does not accept @p value, to go on after
 * "expected": of a choice the words and which was probably meant, else the
 * range and the units; and what to write instead of a decimal comma, a
 * percentage, a formula, or a unit in letters of another case.
 * @param pattern  as deal.II describes it, "pattern_description" of its JSON
 */
std::string expected_value(std::string pattern, const std::string &value);
} // namespace sabot

#endif
