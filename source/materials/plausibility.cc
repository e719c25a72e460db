// Values of materials that a unit must have gone wrong in.
#include "sabot/materials/plausibility.h"

#include "sabot/base/registry.h"
#include "sabot/base/text.h"
#include "sabot/materials/elastic_base.h"

#include <cmath>

namespace sabot
{
namespace
{
/** A family of metals that density and Young's modulus tell, and where its
    cards would put the melting point in degrees Celsius. */
struct Metal
{
  const char *name;
  double density[2], modulus[2]; // [kg/m^3, Pa]
  double celsius[2];             // melting point
};

const Metal metals[] = {
    {"carbon or alloy steel", {7650., 8050.}, {170e9, 225e9}, {1507., 1545.}},
    {"stainless steel", {7650., 8050.}, {170e9, 225e9}, {1390., 1460.}},
    {"aluminum", {2600., 2900.}, {60e9, 85e9}, {470., 665.}},
    {"copper", {8850., 9000.}, {100e9, 140e9}, {1050., 1090.}},
    {"brass", {8300., 8700.}, {95e9, 125e9}, {890., 970.}},
    {"titanium", {4400., 4700.}, {95e9, 125e9}, {1600., 1675.}},
    {"nickel alloy", {8150., 8950.}, {190e9, 230e9}, {1255., 1460.}},
    {"lead", {11000., 11500.}, {10e9, 30e9}, {300., 330.}},
    {"magnesium", {1700., 1850.}, {40e9, 48e9}, {590., 655.}},
    {"tungsten", {19000., 19400.}, {330e9, 420e9}, {3380., 3430.}}};

bool is_between(const double value, const double (&range)[2])
{
  return value >= range[0] && value <= range[1];
}

/** Collects what is odd about one material. */
class Critic
{
public:
  Critic(const Parameters &prm, const std::string &path) : prm(prm), path(path)
  {
  }

  /** The value of an entry of the present subsection, if there is one. */
  std::optional<double> value(const std::string &entry) const
  {
    return prm.is_declared(entry)
               ? std::optional<double>(get_quantity(prm, entry))
               : std::nullopt;
  }

  void say(const std::string &entry, const std::string &message)
  {
    found.push_back(path + "/" + entry + ": " + prm.get(entry) + " " + message);
  }

  std::vector<std::string> found;

private:
  const Parameters &prm;
  const std::string path;
};

void judge_elastic(const ElasticConstants &elastic, Critic &critic)
{
  // From foams to osmium; from soft gels to diamond.
  if (elastic.density < 20.)
    critic.say("Density",
               "is that of a gas; a number alone is in kg/m^3 (steel "
               "has 7830 kg/m^3)");
  if (elastic.density > 23000.)
    critic.say("Density", "is above that of any metal (osmium has 22590 "
                          "kg/m^3)");
  if (elastic.young_modulus < 1e4)
    critic.say("Young's modulus", "is softer than a gel; a number alone is in "
                                  "Pa (steel has 206 GPa)");
  if (elastic.young_modulus > 1.3e12)
    critic.say("Young's modulus", "is above that of diamond (1.2e12 Pa)");
  if (elastic.poisson_ratio < 0.)
    critic.say("Poisson's ratio", "is negative: no metal widens when it is "
                                  "pulled");
}

/** The entry of the law's subsection that says where it first yields. */
std::string yield_entry(const Parameters &prm)
{
  for (const char *const entry :
       {"Initial yield stress", "Yield stress", "Table of stresses"})
    if (prm.is_declared(entry) && prm.get(entry) != "" && prm.get(entry) != "0")
      return entry;
  return "";
}

void judge_strength(const Parameters &prm, const ElasticConstants &elastic,
                    const Material &material, Critic &critic,
                    const std::string &path)
{
  const double E = elastic.young_modulus;
  if (const auto yield = material.initial_yield_stress())
  {
    const double ratio = *yield / E;
    const std::string relation = formatted("%.3g Pa, ", *yield) +
                                 formatted("%.2g times Young's modulus", ratio);
    const std::string entry = yield_entry(prm);
    const std::string where = entry.empty() ? path : path + "/" + entry;
    if (ratio > 0. && ratio < 1e-5)
      critic.found.push_back(where + ": it first yields at " + relation +
                             "; metals do at 1e-4 to 2e-2 times: is a unit "
                             "missing (a number alone is in Pa)?");
    if (ratio > 0.2)
      critic.found.push_back(where + ": it first yields at " + relation +
                             ", beyond the theoretical strength of a crystal "
                             "(about a tenth): is a unit wrong?");
  }
  const auto hardening = critic.value("Hardening modulus");
  if (hardening && *hardening > 0. && *hardening < 1e-6 * E)
    critic.say("Hardening modulus",
               "is next to nothing beside Young's modulus: is a unit missing "
               "(a number alone is in Pa)?");
  if (hardening && *hardening > E)
    critic.say("Hardening modulus", "is above Young's modulus: is a unit "
                                    "wrong?");
}

void judge_melting(const ElasticConstants &elastic, Critic &critic)
{
  const auto melt = critic.value("Melt temperature");
  if (!melt)
    return;
  const double steel[2] = {7650., 8050.};
  if (*melt < 300.)
    return critic.say("Melt temperature",
                      "is below room temperature; a number alone is in K");
  if (is_between(elastic.density, steel) && *melt < 900.)
    return critic.say("Melt temperature",
                      "is far too low for a metal of the density of steel, "
                      "which melts at 1640 to 1810 K");
  for (const Metal &metal : metals)
    if (is_between(elastic.density, metal.density) &&
        is_between(elastic.young_modulus, metal.modulus) &&
        is_between(*melt, metal.celsius))
      return critic.say("Melt temperature",
                        "is the melting point of " + std::string(metal.name) +
                            " in degrees Celsius, but is read as kelvin (" +
                            formatted("%.5g K", *melt + 273.15) + "?)");
}

void judge_temperatures(Critic &critic)
{
  // Below 150 K no card has its reference; 77 K is liquid nitrogen.
  const std::string reference = critic.value("Room temperature")
                                    ? "Room temperature"
                                    : "Reference temperature";
  const auto room = critic.value(reference),
             start = critic.value("Initial temperature"),
             melt = critic.value("Melt temperature");
  if (room && *room < 150.)
    critic.say(
        reference,
        "is read as kelvin; 20 degrees Celsius are 293.15 K" +
            (start && melt && *melt > *room && *start > *room
                 ? "; at the initial temperature the metal would be " +
                       formatted("%.0f %% on its way to melting",
                                 100. * (*start - *room) / (*melt - *room))
                 : std::string()));
  if (start && *start < 60.)
    critic.say("Initial temperature",
               "is read as kelvin; 20 degrees Celsius are 293.15 K");
  if (start && melt && *start >= *melt)
    critic.say("Initial temperature", "is not below the melt temperature: the "
                                      "metal has no strength at all");
}

void judge_heat(Critic &critic)
{
  const auto heat = critic.value("Specific heat");
  if (heat && (*heat < 50. || *heat > 1e4))
    critic.say("Specific heat", "is far from that of any solid, 100 to 2500 "
                                "J/kg/K");
  const auto expansion = critic.value("Thermal expansion");
  if (expansion && *expansion > 1e-3)
    critic.say("Thermal expansion", "is far above that of any metal, 5e-6 to "
                                    "3e-5 1/K");
  const auto conductivity = critic.value("Thermal conductivity");
  if (conductivity && *conductivity > 3000.)
    critic.say("Thermal conductivity", "is above that of diamond, 2200 W/m/K");
}
} // namespace

std::vector<std::string> implausible_values(Parameters &prm,
                                            const std::string &path,
                                            const ElasticConstants &elastic,
                                            const Material &material)
{
  Critic of_material(prm, path);
  judge_elastic(elastic, of_material);
  const std::string model = prm.get("Model");
  const auto *const law = Registry<Material>::find(model);
  // Entering would make a subsection of a law that has none.
  if (law == nullptr || !law->declare)
    return of_material.found;
  prm.enter_subsection(model);
  Critic of_law(prm, path + "/" + model);
  judge_strength(prm, elastic, material, of_law, path + "/" + model);
  judge_melting(elastic, of_law);
  judge_temperatures(of_law);
  judge_heat(of_law);
  prm.leave_subsection();
  std::vector<std::string> found = of_material.found;
  found.insert(found.end(), of_law.found.begin(), of_law.found.end());
  return found;
}
} // namespace sabot
