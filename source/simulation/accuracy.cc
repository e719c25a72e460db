// The entry `Accuracy`: presets of knobs, with what they cost.
#include "sabot/simulation/accuracy.h"

#include "sabot/base/parameters.h"

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
       {{"Failure check interval", "15"},
        {"Kernel update interval", "60"},
        {"Kernel update strain", "0.05"},
        {"Step factor", "0.95"}},
       ""},
      {Accuracy::standard, {}, ""},
      {"reference",
       {{"Failure check interval", "1"},
        {"Kernel update interval", "10"},
        {"Kernel update strain", "0.005"},
        {"Step factor", "0.5"},
        {"Largest number of substeps", "1"}},
       ""}};
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
                    "How the entries that trade speed for accuracy are set "
                    "where the scene leaves them alone; spacings stay." +
                        prices);
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
