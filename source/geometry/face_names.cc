// Faces that a scene names, as numbers.
#include "sabot/geometry/face_names.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"

#include <algorithm>

namespace sabot
{
std::vector<unsigned int> face_ids(const std::string &path,
                                   const std::string &text,
                                   const std::vector<std::string> &allowed)
{
  return word_ids(path, text, allowed, "face");
}

std::vector<unsigned int> word_ids(const std::string &path,
                                   const std::string &text,
                                   const std::vector<std::string> &allowed,
                                   const std::string &what)
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
      throw InputError(path, "\"" + face + "\" is not a " + what +
                                 "; allowed: " + all);
    }
    ids.push_back(found - allowed.begin());
  }
  return ids;
}
} // namespace sabot
