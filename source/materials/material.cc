// The entries of a material: which law, which equation of state, and theirs.
#include "sabot/materials/material.h"

#include "sabot/base/registry.h"
#include "sabot/materials/elastic_base.h"
#include "sabot/materials/plausibility.h"

#include <cmath>

namespace sabot
{
namespace
{
using Laws = Registry<Material>;
using Equations = Registry<EquationOfState>;

/** Declares what the choice @p name brings in a subsection of its own; of a
    name that is not registered all of them, as the manual does. */
template <typename Product>
void declare_subsections(Parameters &prm, const std::string &name)
{
  const bool all = Registry<Product>::find(name) == nullptr;
  for (const auto &entry : Registry<Product>::entries())
    if (entry.declare && (all || entry.name == name))
    {
      prm.enter_subsection(entry.name);
      entry.declare(prm);
      prm.leave_subsection();
    }
}

/** Makes the choice of the entry @p choice from its subsection. */
template <typename Product, typename... Arguments>
auto make_choice(Parameters &prm, const std::string &path,
                 const std::string &choice, Arguments &...arguments)
{
  const auto &entry =
      Registry<Product>::get(path + "/" + choice, prm.get(choice));
  if (entry.declare)
    prm.enter_subsection(entry.name);
  auto product = entry.make(prm, path + "/" + entry.name, arguments...);
  if (entry.declare)
    prm.leave_subsection();
  return product;
}

/** InputError where a subsection @p section belongs to a choice that was not
    made. */
template <typename Product>
void check_subsection(const std::string &path, const std::string &section,
                      const std::string &choice, const std::string &selected)
{
  const auto *const owner = Registry<Product>::find(section);
  if (owner == nullptr || !owner->declare || section == selected)
    return;
  throw InputError(path + "/" + section,
                   "the entries under \"" + section +
                       "\" would have no effect: " + choice + " is \"" +
                       selected + "\"; set " + choice + " = " + section +
                       " or remove them");
}
} // namespace

double Material::sound_speed() const
{
  return std::sqrt((bulk_modulus() + 4. / 3. * shear_modulus()) / density());
}

void Material::declare_parameters(Parameters &prm, const std::string &model,
                                  const std::string &equation_of_state)
{
  Laws::declare_choice(prm, "Model", "Elastic", "Constitutive law.");
  prm.declare_entry("Source", "", any_text(), "Where the values come from.");
  ElasticConstants::declare_parameters(prm);
  Equations::declare_choice(prm, "Equation of state", "Bulk modulus", "");
  declare_subsections<EquationOfState>(prm, equation_of_state);
  declare_subsections<Material>(prm, model);
}

void Material::check_subsections(const std::string &path,
                                 const std::vector<std::string> &subsections,
                                 const std::string &model,
                                 const std::string &equation_of_state)
{
  for (const std::string &section : subsections)
  {
    check_subsection<Material>(path, section, "Model", model);
    check_subsection<EquationOfState>(path, section, "Equation of state",
                                      equation_of_state);
  }
}

std::unique_ptr<Material> Material::make(Parameters &prm,
                                         const std::string &path)
{
  const ElasticConstants elastic = ElasticConstants::parse(prm, path);
  std::vector<std::string> warnings;
  const auto eos = make_choice<EquationOfState>(prm, path, "Equation of state",
                                                elastic, warnings);
  auto material = make_choice<Material>(prm, path, "Model", elastic, eos);
  const std::vector<std::string> odd =
      implausible_values(prm, path, elastic, *material);
  warnings.insert(warnings.end(), odd.begin(), odd.end());
  material->warnings = warnings;
  return material;
}
} // namespace sabot
