// The list of all registries.
#include "sabot/base/registry.h"

#include <algorithm>

namespace sabot
{
namespace
{
std::vector<RegistryContents (*)()> &known()
{
  static std::vector<RegistryContents (*)()> registries;
  return registries;
}
} // namespace

std::vector<RegistryContents> all_registries()
{
  std::vector<RegistryContents> all;
  for (const auto contents : known())
    all.push_back(contents());
  std::sort(all.begin(), all.end(),
            [](const RegistryContents &a, const RegistryContents &b)
            { return a.kind < b.kind; });
  return all;
}

void add_registry(RegistryContents (*contents)())
{
  known().push_back(contents);
}
} // namespace sabot
