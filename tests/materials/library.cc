// Every file of prm/materials: it loads, its values are plausible, and its
// yield stress grows with strain; and what a scene file may not say.
#include "point.h"

#include "sabot/base/error.h"
#include "sabot/base/parameter_file.h"
#include "sabot/simulation/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace
{
using namespace sabot;
const std::string library = std::string(SABOT_SOURCE_DIR) + "/prm/materials";

std::vector<std::string> files()
{
  std::vector<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(library))
    if (entry.path().extension() == ".prm")
      names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

struct Loaded
{
  std::shared_ptr<Material> material;
  std::string model, name, source;
};

/** The only material of a file. */
Loaded load(const std::string &file,
            const std::vector<std::string> &overrides = {})
{
  const ParameterFile parsed(file, overrides);
  Parameters prm;
  Scene::declare(prm, &parsed);
  parsed.parse_into(prm);
  const std::string name = parsed.subsections("Materials").at(0);
  prm.enter_subsection("Materials");
  prm.enter_subsection(name);
  return {Material::make(prm, "Materials/" + name), prm.get("Model"), name,
          prm.get("Source")};
}

class Library : public testing::TestWithParam<std::string>
{
};

TEST_P(Library, loads_with_plausible_values)
{
  const std::string file = library + "/" + GetParam() + ".prm";
  const Loaded loaded = load(file);
  const Material &m = *loaded.material;
  EXPECT_FALSE(loaded.source.empty());
  EXPECT_GT(m.sound_speed(), 1000.);
  EXPECT_LT(m.sound_speed(), 7000.);
  EXPECT_GT(m.density(), 1000.);
  EXPECT_LT(m.density(), 20000.);
  const std::optional<double> yield_stress = m.initial_yield_stress();
  EXPECT_EQ(yield_stress.has_value(), loaded.model != "Elastic");
  if (yield_stress)
  {
    EXPECT_GT(*yield_stress, 5e6);
    EXPECT_LT(*yield_stress, 3e9);
  }
  // rho c0^2 of shock data against K of the elastic constants: within 15 %,
  // save where the sources themselves disagree.
  EXPECT_EQ(m.warnings.size(), GetParam() == "al6061-t6-eos" ? 1u : 0u);
}

TEST_P(Library, has_a_source_beside_each_number)
{
  std::ifstream stream(library + "/" + GetParam() + ".prm");
  for (std::string line; std::getline(stream, line);)
  {
    const std::size_t set = line.find("set ");
    if (set == std::string::npos || line.find('#') < set ||
        line.find("Model") != std::string::npos ||
        line.find("Source") != std::string::npos ||
        line.find("Equation of state") != std::string::npos)
      continue;
    const std::size_t comment = line.find('#');
    EXPECT_TRUE(comment != std::string::npos && comment + 3 < line.size())
        << line;
  }
}

TEST_P(Library, yield_grows_with_strain_and_rate)
{
  const std::string file = library + "/" + GetParam() + ".prm";
  const Loaded first = load(file);
  std::vector<std::string> cold;
  if (first.model != "Hardening plasticity" && first.model != "Elastic")
    cold = {"Materials/" + first.name + "/" + first.model +
            "/Taylor-Quinney fraction=0"};
  const Loaded loaded = load(file, cold);
  if (!loaded.material->initial_yield_stress())
    GTEST_SKIP() << "elastic: never yields";
  double slow = 0.;
  for (const double rate : {1e-3, 1e3, 1e5})
  {
    Point point(*loaded.material);
    double last = 0.;
    for (int i = 0; i < 500; ++i)
    {
      point.step({0, 0, 0, 1e-3, 0, 0}, {0, 0, 0}, 2e-3 / rate);
      // With an equation of state the shear energy is pressure, too, and the
      // shear modulus of Steinberg-Guinan follows it.
      EXPECT_GE(von_mises(point.stress), last * (1. - 1e-9));
      last = von_mises(point.stress);
    }
    EXPECT_GT(last, 10e6);
    EXPECT_LT(last, 60e9);
    EXPECT_GE(last, slow);
    slow = last;
  }
}

TEST_P(Library, fracture_strain_is_positive_in_tension)
{
  const std::string file = library + "/" + GetParam() + ".prm";
  const Loaded plain = load(file);
  if (plain.model != "Johnson-Cook")
    return;
  const std::string path = "Materials/" + plain.name + "/Johnson-Cook/";
  const ParameterFile parsed(file, {});
  if (!parsed.is_set(path + "D2"))
    return;
  const Loaded loaded = load(file, {path + "Damage=true"});
  const double strain = dynamic_cast<const JohnsonCook &>(*loaded.material)
                            .fracture_strain(1. / 3., 1., 294.);
  EXPECT_GT(strain, 0.05);
  EXPECT_LT(strain, 5.);
}

INSTANTIATE_TEST_SUITE_P(files, Library, testing::ValuesIn(files()),
                         [](const testing::TestParamInfo<std::string> &info)
                         {
                           std::string name = info.param;
                           for (char &c : name)
                             c = std::isalnum(c) ? c : '_';
                           return name;
                         });

std::string message(const std::string &material,
                    const std::vector<std::string> &overrides = {})
{
  char name[] = "/tmp/sabot-test-XXXXXX";
  const std::string folder = mkdtemp(name), file = folder + "/scene.prm";
  std::ofstream(file) << "subsection Materials\nsubsection m\n"
                         "set Density = 2700\nset Young's modulus = 70 GPa\n"
                      << material << "end\nend\n";
  std::string text;
  try
  {
    load(file, overrides);
  }
  catch (const InputError &e)
  {
    text = e.parameter + ": " + e.what();
  }
  std::filesystem::remove_all(folder);
  return text;
}

#define EXPECT_CONTAINS(text, part)                                            \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

TEST(Messages, entries_of_a_law_that_is_not_selected_are_refused)
{
  const std::string jc = "subsection Johnson-Cook\n"
                         "set Initial yield stress = 1 MPa\nend\n";
  const std::string m = message("set Model = Elastic\n" + jc);
  EXPECT_CONTAINS(m, "Materials/m/Johnson-Cook");
  EXPECT_CONTAINS(m, "\"Johnson-Cook\" would have no effect");
  EXPECT_CONTAINS(m, "Model is \"Elastic\"");
  EXPECT_CONTAINS(message(jc), "Model is \"Elastic\"");
  EXPECT_EQ(message("set Model = Johnson-Cook\n" + jc), "");
  EXPECT_CONTAINS(message("", {"Materials/m/Johnson-Cook/D1=1"}),
                  "would have no effect");
  EXPECT_CONTAINS(message("set Model = Elastics\n" + jc), "no effect");
  EXPECT_CONTAINS(message("subsection Mie-Gruneisen\nset Shock slope = 1\n"
                          "end\n"),
                  "Equation of state is \"Bulk modulus\"");
  EXPECT_CONTAINS(message("set Model = Elastics\n"), "one of");
}

TEST(Messages, equation_of_state)
{
  const std::string set = "set Equation of state = Mie-Gruneisen\n";
  EXPECT_CONTAINS(message(set), "Mie-Gruneisen/Sound speed");
  EXPECT_EQ(message(set + "subsection Mie-Gruneisen\n"
                          "set Sound speed = 5386 m/s\nend\n"),
            "");
}

TEST(Messages, tables)
{
  const auto table = [](const std::string &strains, const std::string &stresses)
  {
    return message("set Model = Hardening plasticity\n"
                   "subsection Hardening plasticity\nset Table of strains = " +
                   strains + "\nset Table of stresses = " + stresses +
                   "\nend\n");
  };
  EXPECT_EQ(table("0, 0.1, 10", "400 MPa, 410 MPa, 1.4 GPa"), "");
  EXPECT_CONTAINS(table("0, 0.1", "400 MPa"), "has 1 values");
  EXPECT_CONTAINS(table("0.1, 0.2", "1 MPa, 2 MPa"), "start with 0");
  EXPECT_CONTAINS(table("0, 0.2, 0.1", "1 MPa, 2 MPa, 3 MPa"), "must increase");
  EXPECT_CONTAINS(table("0, 0.2", "2 MPa, 1 MPa"), "must not decrease");
  EXPECT_CONTAINS(message("set Model = Hardening plasticity\n"
                          "subsection Hardening plasticity\nset Yield stress = "
                          "1 MPa\nset Table of strains = 0\nset Table of "
                          "stresses = 1 MPa\nend\n"),
                  "set either");
}

TEST(Messages, damage_needs_a_positive_fracture_strain)
{
  EXPECT_CONTAINS(message("set Model = Johnson-Cook\nsubsection Johnson-Cook\n"
                          "set Initial yield stress = 1 MPa\n"
                          "set Damage = true\nend\n"),
                  "must be positive");
}
} // namespace
