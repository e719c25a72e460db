// Writes the reference from what the program itself uses.
#include "sabot/reference/reference.h"

#include "sabot/base/entry_aliases.h"
#include "sabot/base/error.h"
#include "sabot/base/ledger.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/registry.h"
#include "sabot/simulation/scene.h"
#include "sabot/study/study_file.h"

#include <sstream>

namespace sabot
{
namespace
{
const std::string generated =
    "<!-- Written by `sabot reference doc/reference`; not to be edited. -->\n";

std::string scene_page()
{
  Parameters prm;
  Scene::declare(prm, nullptr);
  std::ostringstream text;
  text << generated << "# Entries of scenes\n\n"
       << "A name in angle brackets stands for any name; what follows in them "
          "tells which kind the entries belong to.\n";
  print_tables(prm, text);
  text << "\n## Old names\n\nThe program accepts these, too, and says so in "
          "the log.\n\n| old name | present name |\n|---|---|\n";
  for (const auto &[old_name, name] : entry_aliases())
    text << "| " << old_name << " | " << name << " |\n";
  return text.str();
}

std::string study_page()
{
  Parameters prm;
  StudyFile::declare(prm, {"<name>"}, {"<name>"});
  std::ostringstream text;
  text << generated << "# Entries of studies\n";
  print_tables(prm, text);
  return text.str();
}

std::string fields_page()
{
  std::ostringstream text;
  text << generated << "# Fields of the output\n\n"
       << "Particles carry all fields on their points, bodies of cells those "
          "of motion on nodes and the others in cells. Symmetric tensors have "
          "the components XX, YY, ZZ, XY, YZ, XZ.\n\n"
       << "| field | unit | components | of | meaning |\n|---|---|---|---|---|"
          "\n";
  for (const FieldDescription &field : described_fields())
    text << "| " << field.name << " | " << field.unit << " | "
         << field.n_components << " | " << field.bodies << " | "
         << field.meaning << " |\n";
  return text.str();
}

std::string ledger_page()
{
  std::ostringstream text;
  text << generated << "# Terms of the energy ledger\n\n"
       << "Columns of the table `ledger` in `history.h5` and keys of `energy` "
          "in `result.json`, all in J. The balance is the sum of the parts "
          "less what was supplied from outside; it stays constant but for the "
          "error of the method.\n\n| term | role | meaning |\n|---|---|---|\n";
  for (const EnergyTerm &term : energy_terms)
    text << "| " << term.name << " | "
         << (term.role == EnergyTerm::Role::part       ? "part"
             : term.role == EnergyTerm::Role::supplied ? "supplied from outside"
                                                       : "information")
         << " | " << term.meaning << " |\n";
  return text.str();
}

std::string exit_codes_page()
{
  std::ostringstream text;
  text << generated << "# Exit codes\n\n| code | meaning |\n|---|---|\n";
  for (const ExitCodeMeaning &code : exit_code_meanings())
    text << "| " << static_cast<int>(code.code) << " | " << code.meaning
         << " |\n";
  return text.str();
}

std::string registries_page()
{
  std::ostringstream text;
  text << generated << "# Choices by name\n\n"
       << "What parameter files choose by name. Each choice lives in one "
          "file, which registers it; a new one is known here, in the manual "
          "and in messages without further edits.\n";
  for (const RegistryContents &registry : all_registries())
  {
    text << "\n## " << registry.kind << "\n\n| name | meaning |\n|---|---|\n";
    for (const RegistryContents::Item &item : registry.items)
      text << "| " << item.name << " | " << item.description << " |\n";
  }
  return text.str();
}
} // namespace

std::vector<ReferencePage> reference_pages()
{
  return {{"scene.md", scene_page()},
          {"study.md", study_page()},
          {"fields.md", fields_page()},
          {"ledger.md", ledger_page()},
          {"exit-codes.md", exit_codes_page()},
          {"registries.md", registries_page()}};
}
} // namespace sabot
