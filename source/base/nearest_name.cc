// The name that was probably meant.
#include "sabot/base/nearest_name.h"

#include "sabot/base/error.h"
#include "sabot/base/text.h"

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

/** Whether three letters of five are the same: more is another word. */
bool is_spelled_like(const std::string &a, const std::string &b,
                     const std::size_t distance)
{
  return 5 * distance <= 2 * std::max(a.size(), b.size());
}

/** Whether @p part, of some letters, stands within @p whole. */
bool is_part(const std::string &part, const std::string &whole)
{
  constexpr std::size_t least = 3;
  return part.size() >= least &&
         lower_case(whole).find(lower_case(part)) != std::string::npos;
}
} // namespace

std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &allowed)
{
  std::string nearest;
  std::size_t least = std::string::npos;
  for (const std::string &a : allowed)
  {
    const std::size_t distance = edit_distance(name, a);
    if (distance < least && (is_spelled_like(name, a, distance) ||
                             is_part(name, a) || is_part(a, name)))
    {
      nearest = a;
      least = distance;
    }
  }
  return nearest;
}

std::string suggestion(const std::string &name,
                       const std::vector<std::string> &allowed)
{
  const std::string nearest = nearest_name(name, allowed);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

std::string suggestion_or_list(const std::string &name,
                               const std::vector<std::string> &allowed)
{
  const std::string suggested = suggestion(name, allowed);
  if (!suggested.empty() || allowed.empty())
    return suggested;
  constexpr std::size_t most = 30;
  const std::size_t n = std::min(most, allowed.size());
  return "; there is: " + join({allowed.begin(), allowed.begin() + n}, ", ") +
         (allowed.size() > n
              ? " and " + std::to_string(allowed.size() - n) + " more"
              : "");
}

void throw_unknown_name(const std::string &path, const std::string &what,
                        const std::string &name,
                        const std::vector<std::string> &allowed)
{
  if (name.empty())
    throw InputError(path, "needs the name of a " + what);
  throw InputError(path, "no " + what + " is called \"" + name + "\"" +
                             suggestion_or_list(name, allowed));
}
} // namespace sabot
