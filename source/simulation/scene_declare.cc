// What a scene file may set: every entry with its meaning.
#include "sabot/bodies/discretization.h"
#include "sabot/couplings/coupling_builder.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cctype>

namespace sabot
{
namespace
{
const Pattern names = name_list();

void declare_top(Parameters &prm)
{
  prm.declare_entry("Title", "", any_text(), "What the scene shows; one line.");
  prm.declare_entry("End time", "0.1 ms", quantity(Dimension::time, 1e-12, 1e3),
                    "Physical time at which the run ends.");
  prm.declare_knob("Step factor", "0.9", quantity(Dimension::none, 0.01, 2.),
                   "Step over the least stable step of bodies and "
                   "couplings; above 1 the run is expected to be caught.");
  prm.declare_knob("Largest step", "1 s", quantity(Dimension::time, 1e-15, 1.),
                   "Upper bound of the step.");
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
  prm.declare_entry("List of bodies", "", names,
                    "Names of the bodies, in order.");
  prm.declare_knob("List of couplings", "", names, "Names of the couplings.");
  prm.declare_entry("List of outputs", "", names, "Names of the outputs.");
  prm.declare_entry("List of quantities", "", names,
                    "Names of the quantities of interest in result.json.");
}

void declare_body(Parameters &prm, const std::string &discretization,
                  const std::string &geometry)
{
  Registry<Discretization>::declare_choice(prm, "Discretization", "FEM", "");
  Registry<Shape>::declare_choice(
      prm, "Geometry", "box",
      "Shape of the body, with the same entries for FEM, SPG and rigid "
      "bodies.");
  prm.declare_entry("Material", "", any_text(),
                    "Name of a subsection of Materials.");
  const Pattern vector3 = quantities(Dimension::length, 3, 3, -1e3, 1e3);
  prm.declare_entry("Centre", "0 m, 0 m, 0 m", vector3,
                    "Position of the centre.");
  prm.declare_entry("Initial velocity", "0 m/s, 0 m/s, 0 m/s",
                    quantities(Dimension::velocity, 3, 3, -1e5, 1e5),
                    "Velocity at time 0, less than 100 km/s per component.");
  Registry<Shape>::declare_entries(prm, geometry);
  // Of a shape that there is not reading the file will tell.
  const auto *const chosen = Registry<Shape>::find(geometry);
  const auto shape = chosen == nullptr ? nullptr : chosen->make();
  if (const auto *const d = Registry<Discretization>::find(discretization))
    d->make()->declare(prm, shape.get());
}

void declare_coupling(Parameters &prm, const std::string &type)
{
  Registry<CouplingBuilder>::declare_choice(prm, "Type", "contact", "");
  Registry<CouplingBuilder>::declare_entries(prm, type);
}

void declare_quantity(Parameters &prm, const std::string &type)
{
  Registry<QuantityOfInterest>::declare_choice(prm, "Type", "velocity", "");
  Registry<QuantityOfInterest>::declare_entries(prm, type);
}
} // namespace

void Scene::declare(Parameters &prm, const ParameterFile *file)
{
  declare_top(prm);
  const auto each = [&](const std::string &section,
                        const std::vector<std::string> &kinds,
                        const auto &declare_entries)
  {
    prm.enter_subsection(section);
    std::vector<std::string> present = kinds;
    if (file != nullptr)
    {
      // Listed names must have a subsection; others may stand unused (an
      // including file can shorten a list), but are read as strictly.
      present = file->subsections(section);
      if (section != "Materials")
      {
        std::string list = "List of " + section;
        list[8] = std::tolower(list[8]);
        for (const std::string &name : split_names(file->value(list, "")))
          if (std::find(present.begin(), present.end(), name) == present.end())
            throw InputError(
                list, "\"" + name + "\" is listed, but there is no \"" +
                          section + "/" + name + "\"" +
                          (present.empty()
                               ? std::string()
                               : "; did you mean \"" +
                                     nearest_name(name, present) + "\"?"));
      }
    }
    for (const std::string &name : present)
    {
      prm.enter_subsection(name);
      declare_entries(section + "/" + name, name);
      prm.leave_subsection();
    }
    prm.leave_subsection();
  };
  const auto read = [&](const std::string &path, const std::string &standard)
  { return file == nullptr ? standard : file->value(path, standard); };
  each("Materials", {"<name>"},
       [&](const std::string &path, const auto &)
       {
         // The manual shows all laws, a scene may set the chosen one's only.
         if (file == nullptr)
           return Material::declare_parameters(prm);
         const std::string model = read(path + "/Model", "Elastic"),
                           equation_of_state = read(path + "/Equation of state",
                                                    "Bulk modulus");
         Material::check_subsections(path, file->subsections(path), model,
                                     equation_of_state);
         Material::declare_parameters(prm, model, equation_of_state);
       });
  // Every pair of a shape and a discretization would say all entries of both
  // many times: each once, with a box or as finite elements, says all.
  std::vector<std::string> bodies;
  for (const auto &shape : Registry<Shape>::entries())
    bodies.push_back("<FEM " + shape.name + ">");
  for (const auto &d : Registry<Discretization>::entries())
    if (d.name != "FEM")
      bodies.push_back("<" + d.name + " box>");
  each("Bodies", bodies,
       [&](const std::string &path, const std::string &name)
       {
         const bool manual = file == nullptr;
         declare_body(prm,
                      manual ? name.substr(1, name.find(' ') - 1)
                             : read(path + "/Discretization", "FEM"),
                      manual ? name.substr(name.find(' ') + 1,
                                           name.size() - name.find(' ') - 2)
                             : read(path + "/Geometry", "box"));
       });
  std::vector<std::string> couplings;
  for (const auto &type : Registry<CouplingBuilder>::entries())
    couplings.push_back("<" + type.name + ">");
  each("Couplings", couplings,
       [&](const std::string &path, const std::string &name)
       {
         declare_coupling(prm, file == nullptr
                                   ? name.substr(1, name.size() - 2)
                                   : read(path + "/Type", "contact"));
       });
  each("Outputs", {"<name>"},
       [&](const std::string &path, const auto &)
       {
         Output::declare_parameters(
             prm, file == nullptr ? "" : read(path + "/Type", "VTU"));
       });
  each("Quantities", {"<name>"},
       [&](const std::string &path, const auto &)
       {
         declare_quantity(
             prm, file == nullptr ? "" : read(path + "/Type", "velocity"));
       });
}
} // namespace sabot
