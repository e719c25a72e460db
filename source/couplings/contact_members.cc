// What contact and self-contact of a scene have in common: who takes part.
#include "sabot/couplings/contact_members.h"

#include <algorithm>

namespace sabot
{
void declare_contact(Parameters &prm)
{
  prm.declare_entry("Bodies", "", name_list(),
                    "Bodies that may touch each other.");
  ContactOptions::declare_parameters(prm);
}

std::vector<int> contact_members(const Parameters &prm, const std::string &path,
                                 const CouplingContext &context,
                                 const std::size_t least)
{
  std::vector<int> members;
  for (const std::string &member : split_names(prm.get("Bodies")))
  {
    const int body = context.body_index(path + "/Bodies", member);
    if (std::find(members.begin(), members.end(), body) != members.end())
      throw InputError(path + "/Bodies",
                       "names \"" + member + "\" twice; once is enough");
    members.push_back(body);
  }
  if (members.size() < least)
    throw InputError(path + "/Bodies",
                     "a " + prm.get("Type") + " needs " +
                         (least == 2 ? "two bodies" : "one body") +
                         " at least");
  return members;
}

std::vector<std::pair<int, int>>
pairs_of_members(const std::vector<int> &members, const bool with_themselves)
{
  std::vector<std::pair<int, int>> pairs;
  for (const int a : members)
    for (const int b : members)
      if (a < b || (a == b && with_themselves))
        pairs.emplace_back(a, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

void keep_apart(const std::vector<std::pair<int, int>> &pairs,
                const std::string &path, const std::string &name,
                CouplingContext &context)
{
  for (const auto &pair : pairs)
  {
    const auto [at, is_new] = context.kept_apart.emplace(pair, name);
    if (is_new)
      continue;
    const std::string first = "\"" + context.bodies[pair.first]->name + "\"",
                      second = "\"" + context.bodies[pair.second]->name + "\"";
    throw InputError(
        path + "/Bodies",
        (first == second ? first + " touches itself"
                         : first + " and " + second + " meet") +
            " in \"" + at->second + "\" already, and both would push; name " +
            (first == second ? "it" : "the two") + " in one of them");
  }
}

ContactOptions of_surfaces(const SelfContactOptions &options)
{
  ContactOptions surfaces = options;
  surfaces.stability_fraction = ContactOptions().stability_fraction;
  return surfaces;
}
} // namespace sabot
