// What a scene says that can hardly be meant, for check, plan and run.
#include "sabot/simulation/scene_checks.h"

#include <algorithm>

namespace sabot
{
namespace
{
void append(std::vector<std::string> &all, const std::vector<std::string> &some)
{
  all.insert(all.end(), some.begin(), some.end());
}
} // namespace

void Scene::warn_of_doubts(const ParameterFile &file,
                           const std::vector<Outline> &outlines,
                           const std::set<std::pair<int, int>> &tied)
{
  const std::vector<std::string> listed = names_of("couplings");
  const auto type = [&](const std::string &name)
  { return file.value("Couplings/" + name + "/Type", "contact"); };
  std::vector<std::string> unlisted, contacts, self_contacts;
  for (const std::string &name : file.subsections("Couplings"))
    if (std::find(listed.begin(), listed.end(), name) != listed.end())
    {
      if (type(name) == "contact")
        contacts.push_back(name);
      if (type(name) == "self-contact")
        self_contacts.push_back(name);
    }
    else if (type(name) == "contact")
      unlisted.push_back(name);
  const MotionDoubts motion(*this, outlines, tied);
  append(warnings, motion.missing_contacts(unlisted));
  append(warnings, motion.idle_contacts(contacts));
  append(warnings, motion.idle_self_contacts(self_contacts));
  append(warnings, motion.forgotten_planes());
  append(warnings, motion.zones_left_behind());
  append(warnings, doubtful_end_time(*this));
}
} // namespace sabot
