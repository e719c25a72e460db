// Old names of entries, which stay accepted.
#include "sabot/base/entry_aliases.h"

namespace sabot
{
const std::vector<std::pair<std::string, std::string>> &entry_aliases()
{
  static const std::vector<std::pair<std::string, std::string>> aliases = {
      {"Center", "Centre"},
      {"Neighbor policy", "Neighbour policy"},
      {"Normalized support size", "Normalised support size"},
      {"Refined zone center", "Refined zone centre"},
      {"Stabilization", "Stabilisation"},
      {"Stabilization coefficient", "Stabilisation coefficient"}};
  return aliases;
}

std::string present_name(const std::string &name)
{
  for (const auto &[old_name, present] : entry_aliases())
    if (name == old_name)
      return present;
  return name;
}
} // namespace sabot
