// The declared entries as a tree, and as text for people and programs.
#include "sabot/base/declared_tree.h"

#include "sabot/base/parameter_file.h"

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <sstream>

namespace sabot
{
using nlohmann::ordered_json;

bool is_entry(const ordered_json &node)
{
  return node.is_object() && node.contains("value") &&
         node["value"].is_string();
}

namespace
{
/** deal.II's tree without what it adds. */
ordered_json plain_tree(const ordered_json &tree)
{
  ordered_json plain = ordered_json::object();
  if (!tree.is_object()) // an empty subsection is written as ""
    return plain;
  for (const auto &item : tree.items())
    plain[item.key()] =
        is_entry(item.value()) ? item.value() : plain_tree(item.value());
  return plain;
}

} // namespace

ordered_json declared_tree(const Parameters &prm)
{
  std::ostringstream text;
  const_cast<Parameters &>(prm).handler().print_parameters(
      text, dealii::ParameterHandler::JSON |
                dealii::ParameterHandler::KeepDeclarationOrder);
  return plain_tree(ordered_json::parse(text.str()));
}

namespace
{
void print_section(const ordered_json &tree, const std::string &path,
                   std::ostream &out)
{
  out << "\n## " << (path.empty() ? "Top level" : path)
      << "\n\n| entry | default | meaning | allowed |\n|---|---|---|---|\n";
  const auto cell = [](std::string text)
  {
    for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos;
         i += 2)
      text.insert(i, "\\");
    return text;
  };
  for (const auto &item : tree.items())
    if (is_entry(item.value()))
      out << "| " << item.key() << " | "
          << cell(item.value().value("default_value", "")) << " | "
          << cell(item.value().value("documentation", "")) << " | "
          << cell(item.value().value("pattern_description", "")) << " |\n";
  for (const auto &item : tree.items())
    if (!is_entry(item.value()))
      print_section(item.value(),
                    path.empty() ? item.key() : path + "/" + item.key(), out);
}
} // namespace

void print_tables(const Parameters &prm, std::ostream &out)
{
  print_section(declared_tree(prm), "", out);
}

void print_manual(const Parameters &prm, std::ostream &out)
{
  out << "# Parameters\n";
  print_tables(prm, out);
}

void print_parameters(const Parameters &prm, const std::string &format,
                      std::ostream &out)
{
  using dealii::ParameterHandler;
  const auto style = format == "prm"    ? ParameterHandler::Text
                     : format == "json" ? ParameterHandler::JSON
                     : format == "xml"  ? ParameterHandler::XML
                                        : ParameterHandler::Description;
  const_cast<Parameters &>(prm).handler().print_parameters(
      out, style | ParameterHandler::KeepDeclarationOrder);
}

void print_expanded(const Parameters &prm, std::ostream &out)
{
  const_cast<Parameters &>(prm).handler().print_parameters(
      out, dealii::ParameterHandler::Text |
               dealii::ParameterHandler::KeepDeclarationOrder);
}
} // namespace sabot
