// The pages of the reference are what the program says of itself, and every
// choice by name and every field of a run stands in them.
#include "sabot/reference/reference.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/discretization.h"
#include "sabot/simulation/quantity_of_interest.h"
#include "sabot/simulation/scene.h"
#include "verification/problem.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

namespace
{
using namespace sabot;

const std::string root = SABOT_SOURCE_DIR;

std::vector<ReferencePage> all_pages()
{
  std::vector<ReferencePage> pages = reference_pages();
  pages.push_back({"problems.md", problems_page()});
  return pages;
}

std::string page(const std::string &file)
{
  for (const ReferencePage &p : all_pages())
    if (p.file == file)
      return p.text;
  return "";
}

TEST(Reference, is_what_the_program_writes)
{
  for (const ReferencePage &p : all_pages())
  {
    std::ifstream stream(root + "/doc/reference/" + p.file);
    std::stringstream text;
    text << stream.rdbuf();
    EXPECT_TRUE(text.str() == p.text)
        << "doc/reference/" << p.file
        << " is out of date: sabot reference doc/reference";
  }
}

TEST(Reference, names_all_choices)
{
  const std::string manual = page("scene.md"), list = page("registries.md");
  EXPECT_GE(all_registries().size(), 3u);
  for (const RegistryContents &registry : all_registries())
    for (const RegistryContents::Item &item : registry.items)
    {
      EXPECT_NE(manual.find(item.name + ": " + item.description),
                std::string::npos)
          << registry.kind << " " << item.name;
      EXPECT_NE(list.find("| " + item.name + " | " + item.description),
                std::string::npos);
    }
}

/** Names of the entries below a node of a tree of declarations, by path. */
std::set<std::string> entries_of(const Parameters &prm,
                                 const std::string &section)
{
  std::ostringstream text;
  print_tables(prm, text);
  std::set<std::string> names;
  std::istringstream lines(text.str());
  bool is_here = false;
  for (std::string line; std::getline(lines, line);)
    if (line.compare(0, 3, "## ") == 0)
      is_here = line.compare(3, section.size(), section) == 0;
    else if (is_here && line.compare(0, 2, "| ") == 0)
      names.insert(line.substr(2, line.find(" |", 2) - 2));
  names.erase("entry");
  return names;
}

TEST(Reference, names_all_entries_of_all_kinds_of_bodies)
{
  // Each pair of a discretization and a shape, as a scene declares it.
  Parameters manual;
  Scene::declare(manual, nullptr);
  const std::set<std::string> known = entries_of(manual, "Bodies");
  for (const char *const entry :
       {"Motion", "Angular velocity", "Carve from", "Nose length"})
    EXPECT_EQ(known.count(entry), 1u) << entry;
  const std::string name = ::testing::TempDir() + "body.prm";
  for (const auto &kind : Registry<Discretization>::entries())
    for (const auto &shape : Registry<BodyShape>::entries())
    {
      std::ofstream(name) << "set List of bodies = b\nsubsection Bodies\n"
                             "subsection b\nset Discretization = "
                          << kind.name << "\nset Geometry = " << shape.name
                          << "\nend\nend\n";
      const ParameterFile file(name, {});
      Parameters prm;
      Scene::declare(prm, &file);
      const std::set<std::string> own = entries_of(prm, "Bodies");
      EXPECT_GT(own.size(), 5u);
      for (const std::string &entry : own)
        EXPECT_EQ(known.count(entry), 1u)
            << kind.name << " " << shape.name << ": " << entry;
    }
  std::remove(name.c_str());
}

TEST(Reference, quantities_tell_their_units)
{
  // The others have the unit of the column or field that they are of.
  for (const auto &type : Registry<QuantityOfInterest>::entries())
    EXPECT_EQ(unit_of_quantity(type.name).empty(),
              type.name == "history" || type.name == "largest")
        << type.name;
}

TEST(Reference, names_all_fields_of_runs_and_no_others)
{
  const std::string fields = page("fields.md");
  std::set<std::string> written;
  for (const char *const name : {"core", "torn", "materials"})
  {
    const ParameterFile file(root + "/tests/scenes/" + name + ".prm", {});
    Scene scene(file, MPI_COMM_WORLD);
    scene.distribute();
    for (const auto &body : scene.bodies)
    {
      const OutputMesh mesh = body->output_mesh();
      for (const auto *const some : {&mesh.point_fields, &mesh.cell_fields})
        for (const OutputField &field : *some)
        {
          written.insert(field.name);
          EXPECT_NE(fields.find("| " + field.name + " | " + field.unit + " | " +
                                std::to_string(field.n_components) + " |"),
                    std::string::npos)
              << field.name;
        }
    }
  }
  for (const FieldDescription &field : described_fields())
    EXPECT_EQ(written.count(field.name), 1u) << field.name;
}
} // namespace
