#ifndef sabot_simulation_scene_tools_h
#define sabot_simulation_scene_tools_h

#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"
#include "sabot/simulation/scene.h"

#include <algorithm>

namespace sabot
{
[[noreturn]] inline void unknown_name(const std::string &path,
                                      const std::string &what,
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

/** Numbers of the named faces (or axes) among the allowed ones. */
inline std::vector<unsigned int>
face_ids(const std::string &path, const std::string &text,
         const std::vector<std::string> &allowed)
{
  std::vector<unsigned int> ids;
  for (const std::string &face : split_names(text))
  {
    const auto found = std::find(allowed.begin(), allowed.end(), face);
    if (found == allowed.end())
    {
      std::string all;
      for (const std::string &a : allowed)
        all += (all.empty() ? "" : ", ") + a;
      throw InputError(path, "\"" + face + "\" is not a face; allowed: " + all);
    }
    ids.push_back(found - allowed.begin());
  }
  return ids;
}
} // namespace sabot

#endif
