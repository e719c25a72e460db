// Old names of entries, which stay accepted.
#include "sabot/base/entry_aliases.h"

namespace sabot
{
const std::vector<std::pair<std::string, std::string>> &entry_aliases()
{
  // The first versions spelled as the British do.
  static const std::vector<std::pair<std::string, std::string>> aliases = {
      {"Centre", "Center"},
      {"Neighbour policy", "Neighbor policy"},
      {"Normalised support size", "Normalized support size"},
      {"Refined zone centre", "Refined zone center"},
      {"Stabilisation", "Stabilization"},
      {"Stabilisation coefficient", "Stabilization coefficient"}};
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
