// The name that was probably meant.
#include "sabot/base/nearest_name.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cctype>

namespace sabot
{
namespace
{
/** Levenshtein distance, case-insensitive. */
std::size_t edit_distance(const std::string &a, const std::string &b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const std::size_t substitute = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}
} // namespace

std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &allowed)
{
  return *std::min_element(
      allowed.begin(), allowed.end(),
      [&](const std::string &a, const std::string &b)
      { return edit_distance(name, a) < edit_distance(name, b); });
}

void throw_unknown_name(const std::string &path, const std::string &what,
                        const std::string &name,
                        const std::vector<std::string> &allowed)
{
  if (name.empty())
    throw InputError(path, "needs the name of a " + what);
  std::string message = "no " + what + " is called \"" + name + "\"";
  if (!allowed.empty())
    message += "; did you mean \"" + nearest_name(name, allowed) + "\"?";
  throw InputError(path, message);
}
} // namespace sabot
