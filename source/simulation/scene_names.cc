// Names of a scene that would meet in its results.
#include "sabot/output/file_names.h"
#include "sabot/output/history.h"
#include "sabot/simulation/scene_checks.h"

#include <map>

namespace sabot
{
void check_names(const Parameters &prm)
{
  for (const std::string list :
       {"bodies", "loads", "couplings", "outputs", "quantities"})
  {
    std::set<std::string> known;
    for (const std::string &name : split_names(prm.get("List of " + list)))
      if (!known.insert(name).second)
        throw InputError("List of " + list,
                         "names \"" + name + "\" twice; once is enough");
  }
  std::map<std::string, std::string> files; // name of the body
  for (const std::string &name : split_names(prm.get("List of bodies")))
  {
    if (is_table_of_runs(name))
      throw InputError("List of bodies",
                       "a body cannot be called \"" + name +
                           "\": history.h5 has a table of this name");
    // File systems bear 255 bytes, with what is added.
    constexpr std::size_t longest = 200;
    if (file_name_of(name).size() > longest)
      throw InputError(
          "List of bodies",
          "\"" + name.substr(0, 20) +
              "...\" is too long for the name of a file; at most " +
              std::to_string(longest) + " bytes");
    const auto [at, is_new] = files.emplace(file_name_of(name), name);
    if (!is_new)
      throw InputError("List of bodies",
                       "bodies \"" + at->second + "\" and \"" + name +
                           "\" would write the same files, fields/" +
                           at->first + "_000000.vtu; rename one of them");
  }
}
} // namespace sabot
