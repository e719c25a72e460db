// What a scene says that can hardly be meant, for check, plan and run.
#include "sabot/simulation/scene_checks.h"

#include "sabot/base/text.h"

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

void warn_of_doubts(const ParameterFile &file,
                    const std::vector<Outline> &outlines, const BodyPairs &tied,
                    Scene &scene)
{
  const std::vector<std::string> listed =
      split_names(file.value("List of couplings", ""));
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
  const MotionDoubts motion(scene, outlines, tied);
  motion.refuse_irresistible();
  append(scene.warnings, motion.missing_contacts(unlisted));
  append(scene.warnings, motion.idle_contacts(contacts));
  append(scene.warnings, motion.idle_self_contacts(self_contacts));
  append(scene.warnings, motion.forgotten_planes());
  append(scene.warnings, motion.zones_left_behind());
  append(scene.warnings, doubtful_end_time(scene));
  if (!file.is_set("End time"))
    scene.notes.push_back(
        formatted("\"End time\" is not set: the run ends after %.4g s",
                  scene.settings.end_time));
  append(scene.warnings, slips_of_entries(file, outlines, scene));
  append(scene.warnings, slips_of_loads(file, scene));
  append(scene.warnings, slips_of_zones(file, scene));
}
} // namespace sabot
