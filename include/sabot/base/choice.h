#ifndef sabot_base_choice_h
#define sabot_base_choice_h

#include "sabot/base/registry.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * @p value as a parameter file would have it, without loss of digits.
 * Seventeen significant digits, from which the same double is read back;
 * without a unit, so in SI.
 */
std::string exact_text(const double value);

/**
 * What the registry makes of the choice @p name with these values of its own
 * entries and the defaults of the others, without a parameter file: for tests,
 * problems and benchmarks. Throws InputError for names and values that a file
 * could not have either.
 *
 * For products whose maker takes entries and a name only. The registry is
 * filled by registrations at the start of the program. Not collective.
 */
template <typename Product>
auto choose(const std::string &name,
            const std::vector<std::pair<std::string, std::string>> &values = {})
{
  const auto &entry = Registry<Product>::get(Product::kind, name);
  Parameters prm;
  if (entry.declare)
    entry.declare(prm);
  for (const auto &value : values)
    if (!prm.set(value.first, value.second))
      throw InputError(value.first, "cannot be \"" + value.second + "\" for " +
                                        Product::kind + " " + name);
  return entry.make(prm, name);
}

/**
 * Whether @p text says the same as @p standard: the same words, or the same
 * number in another unit; of "never" also any number from 1e10 on, which older
 * files have in its place.
 * Both converted to SI and compared exactly: "25.4 mm" and "0.0254 m" are the
 * same where the conversions round alike.
 */
bool same_value(const std::string &text, const std::string &standard);

/**
 * An entry that has no effect with the choice made is a mistake: throws
 * InputError for the first entry that only choices other than the present one
 * of @p selector declare and that differs from its default. @p path: of the
 * subsection, for messages.
 *
 * @p prm stands in the subsection that holds @p selector; entries that the
 * chosen one declares, too, count as used. The message names the choice that
 * would read the entry. Not collective; on all ranks alike.
 */
template <typename Product>
void refuse_unused(const Parameters &prm, const std::string &path,
                   const std::string &selector)
{
  const std::string chosen = prm.get(selector);
  Parameters own;
  Registry<Product>::declare_entries(own, chosen);
  const std::vector<std::string> used = own.entry_names();
  for (const auto &other : Registry<Product>::entries())
  {
    if (other.name == chosen || !other.declare)
      continue;
    Parameters theirs;
    other.declare(theirs);
    for (const std::string &entry : theirs.entry_names())
      if (std::find(used.begin(), used.end(), entry) == used.end() &&
          !same_value(prm.get(entry), theirs.get(entry)))
        throw InputError(path + "/" + entry, "has no effect with " + selector +
                                                 " = " + chosen +
                                                 "; remove it or set " +
                                                 selector + " = " + other.name);
  }
}
} // namespace sabot

#endif
