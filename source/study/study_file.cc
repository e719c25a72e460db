// Reads a study file: parameters, quantities, and the runs they make.
#include "sabot/study/study_file.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/simulation/quantity_of_interest.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace sabot
{
namespace
{
std::string first_of(const std::string &label)
{
  return trim(label.substr(0, label.find(',')));
}

/** SI value of the first quantity in a label, NaN when there is none. */
double number_of(const std::string &label)
{
  if (const auto value = read_quantity(first_of(label)))
    return *value;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string beside(const std::string &file, const std::string &name)
{
  const std::size_t slash = file.rfind('/');
  return name.empty() || name[0] == '/' || slash == std::string::npos
             ? name
             : file.substr(0, slash + 1) + name;
}

StudyParameter read_parameter(const Parameters &prm, const std::string &name,
                              const std::string &file)
{
  const std::string path = "Parameters/" + name;
  StudyParameter parameter;
  parameter.name = name;
  const std::string role = prm.get("Role");
  parameter.role = role == "spacing"   ? StudyParameter::Role::spacing
                   : role == "physics" ? StudyParameter::Role::physics
                   : role == "repeat"  ? StudyParameter::Role::repeat
                                       : StudyParameter::Role::knob;
  parameter.entries = split(prm.get("Entries"), ';');
  if (parameter.entries.empty())
    throw InputError(path + "/Entries",
                     "names no entry of the scene; write for example "
                     "\"Bodies/core/Nodal spacing\"");
  const std::vector<std::string> labels = split(prm.get("Labels"), ';');
  for (const std::string &text : split(prm.get("Values"), ';'))
  {
    StudyParameter::Value value;
    const std::vector<std::string> parts = split(text, '|');
    if (parts.size() != 1 && parts.size() != parameter.entries.size())
      throw InputError(path + "/Values",
                       "\"" + text + "\" has " + std::to_string(parts.size()) +
                           " parts for " +
                           std::to_string(parameter.entries.size()) +
                           " entries; give one for all or one for each");
    for (std::size_t e = 0; e < parameter.entries.size(); ++e)
    {
      const std::string &part = parts.size() == 1 ? parts[0] : parts[e];
      value.text.push_back(parameter.entries[e] == "Scene" ? beside(file, part)
                                                           : part);
    }
    value.label = parts[0];
    if (parameter.values.size() < labels.size())
      value.label = labels[parameter.values.size()];
    value.number = number_of(value.label);
    parameter.values.push_back(value);
  }
  if (parameter.values.empty())
    throw InputError(path + "/Values", "lists no value");
  if (!labels.empty() && labels.size() != parameter.values.size())
    throw InputError(path + "/Labels",
                     std::to_string(labels.size()) + " labels for " +
                         std::to_string(parameter.values.size()) + " values");
  if (parameter.role == StudyParameter::Role::spacing)
    for (const StudyParameter::Value &value : parameter.values)
      if (!(value.number > 0.) || !is_told_in(first_of(value.label), "m"))
        throw InputError(path + "/Values", "\"" + value.label +
                                               "\" is not a spacing; use "
                                               "lengths or another role");
  return parameter;
}

void declare_parameter(Parameters &prm)
{
  prm.declare_entry("Entries", "", any_text(),
                    "Paths of the scene's entries that take the values, "
                    "separated by semicolons; \"Scene\" stands for the "
                    "scene's file.");
  prm.declare_entry("Values", "", any_text(),
                    "Values, separated by semicolons, the base first; a "
                    "vertical bar separates those of several entries.");
  prm.declare_entry("Labels", "", any_text(),
                    "Names of the values in tables and charts, separated by "
                    "semicolons; none: the values themselves.");
  prm.declare_entry("Role", "knob", one_of("knob|spacing|physics|repeat"),
                    "knob: trades speed for accuracy; spacing: sizes over "
                    "which convergence is judged; physics: changes the "
                    "problem; repeat: moves it by next to nothing, so that its "
                    "runs show the scatter.");
}

void declare_quantity(Parameters &prm)
{
  prm.declare_entry("Measured value", "nan", any_text(),
                    "Of the experiment, with unit; nan: none.");
  prm.declare_entry("Source", "", any_text(),
                    "Where the measured value comes from.");
  prm.declare_entry("Over", "", any_text(),
                    "Another quantity of the scene: the histories are also "
                    "drawn over it, as velocity over depth.");
  prm.declare_entry("Ballistic fit over", "", any_text(),
                    "The parameter whose values are impact velocities: the "
                    "quantity is fitted as v_r = a (v_i^p - v_bl^p)^(1/p).");
  prm.declare_entry("Measured curve", "", any_text(),
                    "Impact and residual velocities of an experiment in m/s: "
                    "\"303.5: 199.7; 200.4: 71.4\".");
}

/** "303.5: 199.7; 200.4: 71.4" as pairs. */
std::vector<std::pair<double, double>> read_curve(const std::string &path,
                                                  const std::string &text)
{
  std::vector<std::pair<double, double>> curve;
  for (const std::string &point : split(text, ';'))
  {
    const std::vector<std::string> both = split(point, ':');
    std::pair<double, double> values(number_of(both[0]),
                                     both.size() == 2 ? number_of(both[1])
                                                      : number_of(""));
    if (!(values.first > 0.) || !(values.second >= 0.) ||
        !is_told_in(both[0], "m/s") || !is_told_in(both[1], "m/s"))
      throw InputError(path, "\"" + point +
                                 "\" is not a pair of velocities in m/s, as "
                                 "\"303.5: 199.7\"");
    curve.push_back(values);
  }
  return curve;
}

/** InputError where a ballistic fit has no parameter of velocities. */
void check_ballistic(const std::string &path, const std::string &name,
                     const std::vector<StudyParameter> &parameters)
{
  if (name.empty())
    return;
  for (const StudyParameter &parameter : parameters)
    if (parameter.name == name)
    {
      for (const StudyParameter::Value &value : parameter.values)
        if (!(value.number > 0.) || !is_told_in(first_of(value.label), "m/s"))
          throw InputError(path, "the value \"" + value.label + "\" of \"" +
                                     name +
                                     "\" is not a velocity; give labels as "
                                     "\"300 m/s\"");
      return;
    }
  throw InputError(path, "the study has no parameter \"" + name + "\"");
}

/** What a study that looks at nothing can look at. */
std::string quantities_to_name(const std::string &scene)
{
  const std::string listed =
      trim(ParameterFile(scene, {}).value("List of quantities", ""));
  return listed.empty()
             ? "it has no \"List of quantities\" yet: name some there, and "
               "each again as a subsection of \"Quantities\" in the study"
             : "name each that you want as a subsection of \"Quantities\", "
               "which may be empty; it has " +
                   listed;
}
} // namespace

void StudyFile::declare(Parameters &prm,
                        const std::vector<std::string> &parameter_names,
                        const std::vector<std::string> &quantity_names)
{
  prm.declare_entry("Title", "", any_text(), "What the study shows; one line.");
  prm.declare_entry("Scene", "", any_text(),
                    "The scene that is varied, beside the study's file.");
  prm.declare_entry("Fixed entries", "", any_text(),
                    "Entries set in every run: \"Section/Name=value\", "
                    "separated by semicolons.");
  prm.declare_entry("Combination", "one at a time",
                    one_of("one at a time|grid"),
                    "one at a time: each value with the first values of all "
                    "other parameters; grid: every combination.");
  prm.declare_entry("Processes", "1", integer(1, 1024),
                    "Runs at the same time.");
  prm.declare_entry("Ranks per run", "1", integer(1, 4096),
                    "MPI ranks of each run.");
  prm.declare_entry("Pictures", "true", boolean(),
                    "Whether the report shows a section through each run that "
                    "has fields (outputs of type VTU).");
  prm.declare_entry("Picture field", "", any_text(),
                    "Field that colors the sections; none: effective plastic "
                    "strain, or velocity where nothing can yield.");
  prm.declare_entry("Picture times", "", any_text(),
                    "Times of the sections, separated by commas; none: the end "
                    "of the run.");
  const auto each = [&](const char *const section,
                        const std::vector<std::string> &names,
                        void (*const declare_entries)(Parameters &))
  {
    prm.enter_subsection(section);
    for (const std::string &name : names)
    {
      prm.enter_subsection(name);
      declare_entries(prm);
      prm.leave_subsection();
    }
    prm.leave_subsection();
  };
  each("Parameters", parameter_names, declare_parameter);
  each("Quantities", quantity_names, declare_quantity);
}

StudyFile::StudyFile(const std::string &file_name,
                     const std::vector<std::string> &overrides)
{
  const ParameterFile file(file_name, overrides);
  try
  {
    read(file);
    list_runs();
  }
  catch (const InputError &e)
  {
    throw InputError("", file.located(e));
  }
}

void StudyFile::read(const ParameterFile &file)
{
  const std::vector<std::string> names = file.subsections("Parameters"),
                                 quantity_names =
                                     file.subsections("Quantities");
  if (file.is_set("List of bodies") && !file.is_set("Scene"))
    throw InputError("List of bodies",
                     "this is a scene; run it by \"sabot run\", or name it as "
                     "the \"Scene\" of a study file");
  Parameters prm;
  declare(prm, names, quantity_names);
  file.parse_into(prm);
  title = prm.get("Title");
  if (prm.get("Scene").empty())
    throw InputError("Scene", "a study needs the file of a scene");
  scene = beside(file.file_name, prm.get("Scene"));
  is_grid = prm.get("Combination") == "grid";
  n_processes = prm.get_integer("Processes");
  n_ranks = prm.get_integer("Ranks per run");
  fixed = split(prm.get("Fixed entries"), ';');
  const std::string fixed_at = file.origin("Fixed entries") + ": Fixed entries";
  origin_of_fixed = {fixed_at, fixed_at};
  has_pictures = prm.get_bool("Pictures");
  picture_field = prm.get("Picture field");
  picture_times = prm.get("Picture times");
  for (const std::string &name : names)
  {
    prm.enter_subsection("Parameters");
    prm.enter_subsection(name);
    parameters.push_back(read_parameter(prm, name, file.file_name));
    const auto at = [&](const std::string &path)
    { return file.origin(path) + ": " + path; };
    parameters.back().origin = {at("Parameters/" + name + "/Entries"),
                                at("Parameters/" + name + "/Values")};
    prm.leave_subsection();
    prm.leave_subsection();
  }
  if (quantity_names.empty())
    throw InputError("Quantities", "the study looks at no quantity of the "
                                   "scene; " +
                                       quantities_to_name(scene));
  for (const std::string &name : quantity_names)
  {
    prm.enter_subsection("Quantities");
    prm.enter_subsection(name);
    StudyQuantity quantity;
    quantity.name = name;
    quantity.source = prm.get("Source");
    quantity.over = prm.get("Over");
    quantity.ballistic = prm.get("Ballistic fit over");
    check_ballistic("Quantities/" + name + "/Ballistic fit over",
                    quantity.ballistic, parameters);
    quantity.measured_curve = read_curve(
        "Quantities/" + name + "/Measured curve", prm.get("Measured curve"));
    const std::string measured = prm.get("Measured value");
    if (measured != "nan")
    {
      quantity.measured = number_of(measured);
      quantity.measured_text = measured;
      if (quantity.measured != quantity.measured)
        throw InputError("Quantities/" + name + "/Measured value",
                         "\"" + measured + "\" is not a number with a unit");
    }
    quantities.push_back(quantity);
    prm.leave_subsection();
    prm.leave_subsection();
  }
}

bool StudyFile::varies_only(const StudyRun &run, const std::size_t p) const
{
  for (std::size_t o = 0; o < run.choice.size(); ++o)
    if (o != p && run.choice[o] != 0)
      return false;
  return true;
}

std::string StudyFile::label(const StudyRun &run,
                             const std::size_t except) const
{
  std::string text;
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (p != except && run.choice[p] != 0)
      text += (text.empty() ? "" : ", ") + parameters[p].name + " " +
              parameters[p].values[run.choice[p]].label;
  return text;
}
} // namespace sabot
