// What a scene file may set: every entry with its meaning.
#include "sabot/base/text.h"
#include "sabot/bodies/discretization.h"
#include "sabot/couplings/coupling_builder.h"
#include "sabot/simulation/accuracy.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cctype>

namespace sabot
{
namespace
{
const Pattern names = name_list();
const std::string standard_discretization = "FEM";

void declare_top(Parameters &prm)
{
  prm.declare_entry("Title", "", any_text(), "What the scene shows; one line.");
  prm.declare_entry("End time", "0.1 ms", quantity(Dimension::time, 1e-12, 1e3),
                    "Physical time at which the run ends.");
  Accuracy::declare(prm);
  prm.declare_knob(
      "Step factor", "0.9", quantity(Dimension::none, 0.01, 2.),
      "Step over the least stable step of bodies and couplings, an "
      "estimate on the safe side. Above 1, which a warning says, "
      "nothing vouches for it; what is unstable grows, and ends "
      "by the energy balance.");
  prm.declare_knob("Largest step", "1 s", quantity(Dimension::time, 1e-15, 1.),
                   "Upper bound of the step.");
  prm.declare_knob(
      "Largest number of substeps", "2", integer(1, 16),
      "Steps that a body may make within one step of the scene, so that small "
      "or squeezed cells do not rule the steps of all; of bodies that others "
      "meet by contact only, not of tied, converting or driven ones. 1: all "
      "bodies take the same steps. More than 2 soften blows: 3 % of the speed "
      "at 3, 6 % at 4 (\"substeps\").");
  prm.declare_entry("Energy residual limit", "0.05",
                    quantity(Dimension::none, 1e-6, 1e3),
                    "The run stops with exit code 2 when the energy balance "
                    "is off by more than this fraction.");
  prm.declare_entry("Checkpoint interval", "0 s",
                    quantity(Dimension::time, 0., 1e3),
                    "Physical time between checkpoints; 0: not by time. An "
                    "interrupted run always leaves one.");
  prm.declare_entry("Checkpoint interval in steps", "0", integer(0),
                    "Steps between checkpoints; 0: not by steps.");
  prm.declare_entry("Checkpoint interval of wall time", "600 s",
                    quantity(Dimension::time, 0., 1e7),
                    "Wall-clock time between checkpoints; 0: not by wall "
                    "time.");
  prm.declare_entry(
      "Checkpoint at the end", "true", boolean(),
      "Leave a checkpoint before the last step, which is cut to "
      "meet the end time: \"sabot resume DIR --set 'End time=...'\" "
      "then goes on as if the run had never ended.");
  prm.declare_entry(
      "Ranks per checkpoint file", "16", integer(1),
      "As many ranks save what they have in one file, which one of them "
      "writes; more ranks than that leave several files per checkpoint, which "
      "are written at the same time.");
  prm.declare_entry("List of bodies", "", names,
                    "Names of the bodies, in order.");
  prm.declare_entry("List of loads", "", names,
                    "Names of the loads: what acts on bodies from outside.");
  prm.declare_knob("List of couplings", "", names, "Names of the couplings.");
  prm.declare_entry("List of outputs", "", names, "Names of the outputs.");
  prm.declare_entry("List of quantities", "", names,
                    "Names of the quantities of interest in result.json.");
}

void declare_body(Parameters &prm, const std::string &discretization,
                  const std::string &geometry)
{
  Registry<Discretization>::declare_knob(prm, "Discretization",
                                         standard_discretization, "");
  Registry<BodyShape>::declare_choice(
      prm, "Geometry", "box",
      "Shape of the body, with the same entries for FEM, SPG and rigid "
      "bodies.");
  prm.declare_entry("Material", "", any_text(),
                    "Name of a subsection of Materials.");
  const Pattern vector3 = quantities(Dimension::length, 3, 3, -1e3, 1e3);
  prm.declare_entry("Center", "0 m, 0 m, 0 m", vector3,
                    "Position of the center.");
  prm.declare_entry("Initial velocity", "0 m/s, 0 m/s, 0 m/s",
                    quantities(Dimension::velocity, 3, 3, -1e5, 1e5),
                    "Velocity at time 0, less than 100 km/s per component.");
  prm.declare_entry("Initial speed", "0 m/s",
                    quantity(Dimension::velocity, -1e5, 1e5),
                    "Speed at time 0 along the axis of the body, which turns "
                    "with it; adds to \"Initial velocity\". The axis is the "
                    "cylinder's, that of the projectile towards its nose, z of "
                    "other shapes.");
  Turn::declare(prm);
  Registry<BodyShape>::declare_entries(prm, geometry);
  // Of a shape that there is not reading the file will tell.
  const auto *const chosen = Registry<BodyShape>::find(geometry);
  const auto shape = chosen == nullptr ? nullptr : chosen->make();
  if (const auto *const d = Registry<Discretization>::find(discretization))
    d->make()->declare(prm, shape.get());
}

bool are_known(const std::vector<std::string> &names,
               const std::vector<std::string> &known)
{
  return std::all_of(
      names.begin(), names.end(),
      [&](const std::string &name)
      { return std::find(known.begin(), known.end(), name) != known.end(); });
}

/** Names of the subsections of @p section that the file has; each name in its
    list must have one. Others may stand unused (an including file can shorten
    a list), but are read as strictly. */
std::vector<std::string> present_names(const ParameterFile &file,
                                       const std::string &section)
{
  const std::vector<std::string> present = file.subsections(section);
  std::string list = "List of " + section;
  list[8] = std::tolower(list[8]);
  for (const std::string &name : split_names(file.value(list, "")))
    if (std::find(present.begin(), present.end(), name) == present.end() &&
        are_known(split(name, ' '), present))
      throw InputError(list, "names are separated by commas: \"" +
                                 join(split(name, ' '), ", ") + "\"");
    else if (std::find(present.begin(), present.end(), name) == present.end())
      throw InputError(list, "\"" + name + "\" is listed, but there is no \"" +
                                 section + "/" + name + "\"" +
                                 suggestion_or_list(name, present));
  return present;
}

/** Calls @p declare_entries(path, name) within each subsection of @p section:
    those of the file, or @p manual_names for the manual. */
template <typename Declare>
void declare_section(Parameters &prm, const ParameterFile *file,
                     const std::string &section,
                     const std::vector<std::string> &manual_names,
                     const Declare &declare_entries)
{
  prm.enter_subsection(section);
  for (const std::string &name :
       file == nullptr ? manual_names : present_names(*file, section))
  {
    prm.enter_subsection(name);
    declare_entries(section + "/" + name, name);
    prm.leave_subsection();
  }
  prm.leave_subsection();
}

/** Of things whose entry "Type" chooses among the products of a registry. */
template <typename Product, bool is_knob>
void declare_products(Parameters &prm, const ParameterFile *file,
                      const std::string &section, const std::string &standard)
{
  declare_section(
      prm, file, section, {"<name>"},
      [&](const std::string &path, const std::string &)
      {
        Registry<Product>::declare_choice(prm, "Type", standard, "");
        if constexpr (is_knob)
          prm.mark_as_knob("Type");
        Registry<Product>::declare_entries(
            prm, file == nullptr ? "" : file->value(path + "/Type", standard));
      });
}

void declare_materials(Parameters &prm, const ParameterFile *file)
{
  declare_section(
      prm, file, "Materials", {"<name>"},
      [&](const std::string &path, const std::string &)
      {
        // The manual shows all laws, a scene may set the chosen one's only.
        if (file == nullptr)
          return Material::declare_parameters(prm);
        const std::string model = file->value(path + "/Model", "Elastic"),
                          equation_of_state = file->value(
                              path + "/Equation of state", "Bulk modulus");
        Material::check_subsections(path, file->subsections(path), model,
                                    equation_of_state);
        Material::declare_parameters(prm, model, equation_of_state);
      });
}

void declare_bodies(Parameters &prm, const ParameterFile *file)
{
  // Every pair of a shape and a discretization would say all entries of both
  // many times: each once, with a box or as finite elements, says all.
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::string>> kinds;
  for (const auto &shape : Registry<BodyShape>::entries())
    kinds.emplace_back(standard_discretization, shape.name);
  for (const auto &d : Registry<Discretization>::entries())
    if (d.name != standard_discretization)
      kinds.emplace_back(d.name, "box");
  for (const auto &[discretization, shape] : kinds)
    names.push_back("<" + discretization + " " + shape + ">");
  declare_section(
      prm, file, "Bodies", names,
      [&](const std::string &path, const std::string &name)
      {
        if (file != nullptr)
          return declare_body(
              prm,
              file->value(path + "/Discretization", standard_discretization),
              file->value(path + "/Geometry", "box"));
        const auto &kind =
            kinds[std::find(names.begin(), names.end(), name) - names.begin()];
        declare_body(prm, kind.first, kind.second);
      });
}
} // namespace

void Scene::declare(Parameters &prm, const ParameterFile *file)
{
  if (file != nullptr)
    prm.set_standards(
        Accuracy::standards(file->value(Accuracy::entry, Accuracy::standard)));
  declare_top(prm);
  declare_materials(prm, file);
  declare_bodies(prm, file);
  declare_products<Load, false>(prm, file, "Loads", "gravity");
  declare_products<CouplingBuilder, true>(prm, file, "Couplings", "contact");
  declare_section(
      prm, file, "Outputs", {"<name>"},
      [&](const std::string &path, const std::string &)
      {
        SceneOutput::declare_parameters(
            prm, file == nullptr ? "" : file->value(path + "/Type", "VTU"));
      });
  declare_products<QuantityOfInterest, false>(prm, file, "Quantities",
                                              "velocity");
}
} // namespace sabot
