// The pages of the reference are what the program says of itself, and every
// choice by name and every field of a run stands in them.
#include "sabot/reference/reference.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"
#include "sabot/simulation/scene.h"
#include "verification/problem.h"

#include <gtest/gtest.h>

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
