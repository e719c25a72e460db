// Metals of prm/materials for verification problems, tests and benchmarks.
#include "verification/metals.h"

#include "sabot/base/parameter_file.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"

#include <cstdio>
#include <filesystem>
#include <map>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

/** prm/materials of an installed program, else of the source tree. */
std::string library()
{
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none),
                 installed = program.parent_path() / "../share/sabot/prm";
  return (fs::exists(installed, none) ? installed : fs::path(SABOT_PRM_DIR)) /
         "materials";
}

/** A file of the library, read once, and where its only material stands:
    "Materials/NAME" with the name that it has there. */
struct Source
{
  explicit Source(const std::string &name)
      : file(library() + "/" + name + ".prm", {}),
        own(file.subsections("Materials").at(0)), path("Materials/" + own)
  {
  }
  const ParameterFile file;
  const std::string own, path;
};

const Source &source(const std::string &name)
{
  static std::map<std::string, Source> known;
  return known.try_emplace(name, name).first->second;
}

/** Give @p use the parsed section of the material with @p changes. */
template <typename Use>
void with_section(const std::string &name,
                  const std::vector<std::string> &changes, const Use &use)
{
  const Source &from = source(name);
  std::vector<std::string> overrides;
  for (const std::string &change : changes)
    overrides.push_back(from.path + "/" + change);
  Parameters prm;
  {
    const EnteredSubsection section(prm, "Materials", from.own);
    Material::declare_parameters(prm);
  }
  ParameterFile(from.file.file_name, overrides).parse_into(prm);
  const EnteredSubsection section(prm, "Materials", from.own);
  use(prm, from.path);
}
} // namespace

std::shared_ptr<const Material> metal(const std::string &name,
                                      const std::vector<std::string> &changes)
{
  std::string key = name;
  for (const std::string &change : changes)
    key += "\n" + change;
  static std::map<std::string, std::shared_ptr<const Material>> known;
  std::shared_ptr<const Material> &law = known[key];
  if (!law)
    with_section(name, changes,
                 [&](Parameters &prm, const std::string &path)
                 { law = Material::make(prm, path); });
  return law;
}

const ElasticConstants &elastic_constants(const std::string &name)
{
  static std::map<std::string, ElasticConstants> known;
  const auto found = known.find(name);
  if (found != known.end())
    return found->second;
  with_section(name, {},
               [&](const Parameters &prm, const std::string &path)
               { known[name] = ElasticConstants::parse(prm, path); });
  return known[name];
}

double metal_entry(const std::string &name, const std::string &entry)
{
  const Source &from = source(name);
  const std::string path = from.path + "/" + entry;
  const auto value = read_quantity(from.file.value(path, ""));
  if (!value)
    throw InputError(path, "is not set in " + from.file.file_name);
  return *value;
}

JohnsonCookParameters johnson_cook_parameters(const std::string &name)
{
  const auto entry = [&](const char *const e)
  { return metal_entry(name, std::string("Johnson-Cook/") + e); };
  JohnsonCookParameters p;
  p.A = entry("Initial yield stress");
  p.B = entry("Hardening modulus");
  p.n = entry("Hardening exponent");
  p.C = entry("Strain rate coefficient");
  p.m = entry("Thermal softening exponent");
  p.reference_strain_rate = entry("Reference strain rate");
  p.room_temperature = entry("Room temperature");
  p.initial_temperature = entry("Initial temperature");
  p.melt_temperature = entry("Melt temperature");
  p.specific_heat = entry("Specific heat");
  p.taylor_quinney = entry("Taylor-Quinney fraction");
  for (int i = 0; i < 5; ++i)
    p.D[i] = entry(("D" + std::to_string(i + 1)).c_str());
  return p;
}

MieGruneisenParameters mie_gruneisen_parameters(const std::string &name)
{
  const auto entry = [&](const char *const e)
  { return metal_entry(name, std::string("Mie-Gruneisen/") + e); };
  return {elastic_constants(name).density, entry("Sound speed"),
          entry("Shock slope"), entry("Gruneisen coefficient"), 0.};
}

std::string change(const std::string &entry, const double value)
{
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.17g", value);
  return entry + "=" + digits;
}

namespace
{
const char *const al6061 = "al6061-t6";
}

const ElasticConstants &aluminum()
{
  return elastic_constants(al6061);
}

double aluminum_yield_stress()
{
  return metal_entry(al6061, "Johnson-Cook/Initial yield stress");
}

std::shared_ptr<const Material> elastic(const double poisson_ratio)
{
  return metal(al6061,
               {"Model=Elastic", change("Poisson's ratio", poisson_ratio)});
}

std::shared_ptr<const Material>
hardening_aluminum(const double yield, const double modulus,
                   const double isotropic_fraction)
{
  const std::string law = "Hardening plasticity";
  return metal(al6061,
               {"Model=" + law, change(law + "/Yield stress", yield),
                change(law + "/Hardening modulus", modulus),
                change(law + "/Isotropic fraction", isotropic_fraction)});
}

std::shared_ptr<const Material> hardening_aluminum()
{
  return hardening_aluminum(aluminum_yield_stress(), 150e6);
}

std::shared_ptr<const Material> taylor_copper()
{
  return metal("copper-taylor");
}
} // namespace sabot
