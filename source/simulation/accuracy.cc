// The entry `Accuracy`: presets of knobs, with what they cost.
#include "sabot/simulation/accuracy.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"

namespace sabot
{
namespace
{
struct Preset
{
  std::string name;
  std::map<std::string, std::string> knobs;
  std::string price;
};

const std::vector<Preset> &presets()
{
  static const std::vector<Preset> all = {
      {"fast",
       {{"Spacing factor", "1.5"}, {"Failure check interval", "10"}},
       "0.2 to 0.4 of the time of balanced; off the reference by 2 % of the "
       "plate's absorbed energy, 0.1 and 1.7 % of length and radius of a "
       "Taylor bar, 9 % of a rod's depth"},
      {Accuracy::standard,
       {},
       "off the reference by 1 % of the plate's absorbed energy, 0.1 and 1.1 % "
       "of length and radius of a Taylor bar, 2 % of a rod's depth"},
      {"reference",
       {{"Spacing factor", "0.75"},
        {"Failure check interval", "1"},
        {"Step factor", "0.5"},
        {"Largest number of substeps", "1"}},
       "4 to 11 times the time of balanced"}};
  return all;
}
} // namespace

void Accuracy::declare(Parameters &prm)
{
  std::string names, prices;
  for (const Preset &preset : presets())
  {
    names += (names.empty() ? "" : "|") + preset.name;
    prices += " " + preset.name + ": " + preset.price + ".";
  }
  prm.declare_entry(entry, standard, one_of(names),
                    "How entries that trade speed for accuracy are set where "
                    "the scene leaves them alone." +
                        prices);
  prm.declare_knob("Spacing factor", "1", quantity(Dimension::none, 0.05, 20.),
                   "By which all nodal spacings and cell sizes are multiplied; "
                   "meshes from files stay.");
}

void Accuracy::scale_spacings(Parameters &prm,
                              const std::vector<std::string> &bodies)
{
  const double factor = get_quantity(prm, "Spacing factor");
  if (factor == 1.)
    return;
  for (const std::string &name : bodies)
  {
    const EnteredSubsection entered(prm, "Bodies", name);
    for (const std::string spacing :
         {"Nodal spacing", "Cell size", "Coarsest cell size"})
    {
      if (!prm.is_declared(spacing) || prm.get(spacing) == "none")
        continue;
      std::string scaled;
      for (const double h : get_quantities(prm, spacing))
        scaled +=
            (scaled.empty() ? "" : ", ") + formatted("%.15g m", factor * h);
      if (!prm.set(spacing, scaled))
        throw InputError("Spacing factor",
                         formatted("makes %g times ", factor) + "Bodies/" +
                             name + "/" + spacing + " (" + prm.get(spacing) +
                             "), which is out of its range");
    }
  }
  prm.set("Spacing factor", "1");
}

std::map<std::string, std::string> Accuracy::standards(const std::string &name)
{
  for (const Preset &preset : presets())
    if (preset.name == name)
      return preset.knobs;
  return {};
}

std::string Accuracy::price(const std::string &name)
{
  for (const Preset &preset : presets())
    if (preset.name == name)
      return preset.price;
  return "";
}
} // namespace sabot
