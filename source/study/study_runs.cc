// The runs that a study makes, each checked before any is started.
#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/simulation/quantity_of_interest.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"
#include "sabot/study/study_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace sabot
{
namespace
{
/** InputError for @p entry where @p scene is no file. */
const std::string &existing_scene(const std::string &scene,
                                  const std::string &entry)
{
  if (!std::ifstream(scene))
    throw InputError(entry, "cannot read the scene \"" + scene + "\"");
  return scene;
}

/** What is wrong is told by the line that sets it, in the files of the scene or
    in that of the study. */
void parse_scene(const ParameterFile &file, Parameters &prm)
{
  try
  {
    Scene::declare(prm, &file);
    file.parse_into(prm);
  }
  catch (const InputError &error)
  {
    throw InputError("", file.located(error));
  }
}

/** InputError where an override names a subsection that the scene's own files
    do not have and none of its lists calls for: it would change nothing. */
void check_sections(const StudyRun &run, const ParameterFile &scene)
{
  const ParameterFile plain(run.scene, {});
  for (std::size_t i = 0; i < run.overrides.size(); ++i)
  {
    const std::vector<std::string> path =
        split(run.overrides[i].substr(0, run.overrides[i].find('=')), '/');
    if (path.size() < 3)
      continue;
    const std::string list = "List of " + lower_case(path[0]);
    const std::vector<std::string> known = plain.subsections(path[0]),
                                   listed = split_names(scene.value(list, ""));
    const auto has = [&](const std::vector<std::string> &names)
    { return std::find(names.begin(), names.end(), path[1]) != names.end(); };
    if (scene.is_set(list) && !has(known) && !has(listed))
      throw InputError("", run.origins[i].entry + ": the scene \"" + run.scene +
                               "\" has no \"" + path[0] + "/" + path[1] + "\"" +
                               suggestion_or_list(path[1], known));
  }
}

/** InputError for @p entry where the scene has no quantity @p name. */
void check_quantity(const std::string &entry, const std::string &scene,
                    const std::vector<std::string> &known,
                    const std::string &name)
{
  if (name.empty() ||
      std::find(known.begin(), known.end(), name) != known.end())
    return;
  throw InputError(entry, "scene \"" + scene + "\" has no quantity \"" + name +
                              "\"" + suggestion_or_list(name, known));
}

/** InputError for @p entry where a measured value has another dimension than
    the quantity of the scene. */
void check_measured(const std::string &entry, const StudyQuantity &quantity,
                    const ParameterFile &scene)
{
  const std::string type = scene.value("Quantities/" + quantity.name + "/Type",
                                       "velocity"),
                    unit = unit_of_quantity(type);
  if (quantity.measured_text.empty() || unit.empty() ||
      is_told_in(quantity.measured_text, unit))
    return;
  throw InputError(entry, "is " + quantity.measured_text + ", but \"" +
                              quantity.name + "\" is of the type " + type +
                              ", in " + unit);
}
} // namespace

void StudyFile::list_runs()
{
  std::vector<std::vector<std::size_t>> choices = {
      std::vector<std::size_t>(parameters.size(), 0)};
  for (std::size_t p = 0; p < parameters.size(); ++p)
  {
    const std::size_t n = is_grid ? choices.size() : 1;
    for (std::size_t v = 1; v < parameters[p].values.size(); ++v)
      for (std::size_t i = 0; i < n; ++i)
      {
        choices.push_back(choices[i]);
        choices.back()[p] = v;
      }
  }
  for (const std::vector<std::size_t> &choice : choices)
    runs.push_back(make_run(choice));
}

StudyRun StudyFile::make_run(const std::vector<std::size_t> &choice) const
{
  StudyRun run;
  run.choice = choice;
  run.scene = existing_scene(scene, "Scene");
  run.overrides = fixed;
  run.origins.assign(fixed.size(), origin_of_fixed);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    for (std::size_t e = 0; e < parameters[p].entries.size(); ++e)
    {
      const std::string &entry = parameters[p].entries[e],
                        &text = parameters[p].values[choice[p]].text[e];
      if (entry == "Scene")
        run.scene = existing_scene(text, "Parameters/" + parameters[p].name +
                                             "/Values");
      else
      {
        run.overrides.push_back(entry + "=" + text);
        run.origins.push_back(parameters[p].origin);
      }
    }
  // The expanded parameters, as the run itself will write them.
  const ParameterFile scene_file(run.scene, run.overrides, run.origins);
  Parameters prm;
  parse_scene(scene_file, prm);
  check_sections(run, scene_file);
  std::ostringstream text;
  text << version() << "\n";
  print_expanded(prm, text);
  run.key = sha256(text.str()).substr(0, 16);
  const std::vector<std::string> known =
      split_names(prm.get("List of quantities"));
  for (const StudyQuantity &quantity : quantities)
  {
    const std::string path = "Quantities/" + quantity.name;
    check_quantity(path, run.scene, known, quantity.name);
    check_measured(path + "/Measured value", quantity, scene_file);
    check_quantity(path + "/Over", run.scene, known, quantity.over);
  }
  return run;
}
} // namespace sabot
