// Reads parameter files with includes and overrides; writes manuals.
#include "sabot/base/parameter_file.h"

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace sabot
{
namespace
{
using nlohmann::ordered_json;

std::string trim(const std::string &text)
{
  const char *const blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank),
                    last = text.find_last_not_of(blank);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, last - first + 1);
}

std::string join(const std::vector<std::string> &section,
                 const std::string &name = "")
{
  std::string path;
  for (const std::string &s : section)
    path += (path.empty() ? "" : "/") + s;
  if (!name.empty())
    path += (path.empty() ? "" : "/") + name;
  return path;
}

std::string folder_of(const std::string &file)
{
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "" : file.substr(0, slash + 1);
}

/** A declared entry has a value, a subsection has not. */
bool is_entry(const ordered_json &node)
{
  return node.is_object() && node.contains("value") &&
         node["value"].is_string();
}

/** The tree of declared entries; empty subsections are objects, too. */
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

ordered_json declared_tree(const Parameters &prm)
{
  std::ostringstream text;
  const_cast<Parameters &>(prm).handler().print_parameters(
      text, dealii::ParameterHandler::JSON |
                dealii::ParameterHandler::KeepDeclarationOrder);
  return plain_tree(ordered_json::parse(text.str()));
}

/** Sections in which an entry of this name is declared. */
void find_entry(const ordered_json &tree, const std::string &name,
                const std::string &path, std::vector<std::string> &found)
{
  for (const auto &item : tree.items())
    if (is_entry(item.value()))
    {
      if (item.key() == name)
        found.push_back(path.empty() ? "the top level" : path);
    }
    else
      find_entry(item.value(), name,
                 path.empty() ? item.key() : path + "/" + item.key(), found);
}

[[noreturn]] void fail(const std::string &origin, const std::string &path,
                       const std::string &message)
{
  throw InputError(path, (origin.empty() ? "" : origin + ": ") + message);
}
} // namespace

ParameterFile::ParameterFile(const std::string &file,
                             const std::vector<std::string> &overrides)
    : file_name(file)
{
  std::vector<std::string> section, open_files;
  read(file, "", section, open_files);
  for (const std::string &text : overrides)
  {
    const std::size_t equals = text.find('=');
    const std::string path = trim(text.substr(0, equals));
    if (equals == std::string::npos || path.empty())
      fail("--set \"" + text + "\"", "",
           "expected \"Section/Name=value\", for example "
           "\"End time=2 us\"");
    Entry entry;
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '/');)
      entry.section.push_back(trim(part));
    entry.name = entry.section.back();
    entry.section.pop_back();
    entry.value = trim(text.substr(equals + 1));
    entry.origin = "--set \"" + text + "\"";
    add(entry);
  }
}

void ParameterFile::read(const std::string &file,
                         const std::string &included_at,
                         std::vector<std::string> &section,
                         std::vector<std::string> &open_files)
{
  if (std::find(open_files.begin(), open_files.end(), file) != open_files.end())
    fail(included_at, "", "file \"" + file + "\" includes itself");
  std::ifstream stream(file);
  std::stringstream content(
      std::string{std::istreambuf_iterator<char>(stream), {}});
  if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file))
    fail(included_at, "",
         "cannot read parameter file \"" + file +
             "\"; check its name and that it is a readable text file");
  open_files.push_back(file);

  const std::size_t depth = section.size();
  std::vector<std::string> opened; // origin of each open subsection
  std::string line;
  for (unsigned int n = 1, first_line = 1; std::getline(content, line); ++n)
  {
    first_line = n;
    std::string text = line.substr(0, line.find('#'));
    while (!trim(text).empty() && trim(text).back() == '\\')
    {
      text = trim(text);
      text.pop_back();
      if (!std::getline(content, line))
        break;
      ++n;
      text += trim(line.substr(0, line.find('#')));
    }
    text = trim(text);
    if (text.empty())
      continue;
    const std::string origin = file + ":" + std::to_string(first_line);
    const std::size_t blank = text.find_first_of(" \t");
    const std::string word = text.substr(0, blank);
    const std::string rest =
        blank == std::string::npos ? "" : trim(text.substr(blank));
    if (word == "subsection" && !rest.empty())
    {
      section.push_back(rest);
      opened.push_back(origin);
      const std::string path = join(section);
      if (std::none_of(sections.begin(), sections.end(),
                       [&](const auto &s) { return s.first == path; }))
        sections.emplace_back(path, origin);
    }
    else if (word == "end" && rest.empty())
    {
      if (section.size() == depth)
        fail(origin, "", "\"end\" without a subsection");
      section.pop_back();
      opened.pop_back();
    }
    else if (word == "set")
    {
      const std::size_t equals = rest.find('=');
      const std::string name = trim(rest.substr(0, equals));
      if (equals == std::string::npos || name.empty())
        fail(origin, join(section),
             "expected \"set Name = value\", found \"" + text + "\"");
      add({section, name, trim(rest.substr(equals + 1)), origin, file});
    }
    else if (word == "include" && !rest.empty())
      read(rest[0] == '/' ? rest : folder_of(file) + rest, origin, section,
           open_files);
    else
      fail(origin, join(section),
           "expected set, subsection, end or include, found \"" + text + "\"");
  }
  if (!opened.empty())
    fail(opened.back(), join(section),
         "subsection \"" + section.back() + "\" has no \"end\"");
  open_files.pop_back();
}

void ParameterFile::add(const Entry &entry)
{
  const std::string path = join(entry.section, entry.name);
  const auto known = number.find(path);
  if (known == number.end())
  {
    number[path] = entries.size();
    entries.push_back(entry);
    return;
  }
  Entry &old = entries[known->second];
  if (!entry.file.empty() && old.file == entry.file)
    fail(entry.origin, path,
         "\"" + path + "\" was already set at " + old.origin +
             "; keep one of the two");
  old = entry;
}

std::vector<std::string>
ParameterFile::subsections(const std::string &path) const
{
  const std::string prefix = path + "/";
  std::vector<std::string> names;
  const auto consider = [&](const std::string &section)
  {
    if (section.compare(0, prefix.size(), prefix) != 0)
      return;
    const std::string name = section.substr(
        prefix.size(), section.find('/', prefix.size()) - prefix.size());
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  for (const auto &section : sections)
    consider(section.first);
  for (const Entry &entry : entries)
    if (!entry.section.empty())
      consider(join(entry.section));
  return names;
}

bool ParameterFile::is_set(const std::string &path) const
{
  return number.count(path) > 0;
}

std::string ParameterFile::value(const std::string &path,
                                 const std::string &standard) const
{
  const auto found = number.find(path);
  return found == number.end() ? standard : entries[found->second].value;
}

std::string ParameterFile::origin(const std::string &path) const
{
  for (std::string p = path; !p.empty();
       p = p.rfind('/') == std::string::npos ? "" : p.substr(0, p.rfind('/')))
  {
    const auto found = number.find(p);
    if (found != number.end())
      return entries[found->second].origin;
    for (const auto &section : sections)
      if (section.first == p)
        return section.second;
  }
  return file_name;
}

void ParameterFile::parse_into(Parameters &prm) const
{
  const ordered_json tree = declared_tree(prm);
  for (const Entry &entry : entries)
  {
    const std::string path = join(entry.section, entry.name);
    const ordered_json *node = &tree;
    std::string above;
    for (std::size_t depth = 0; depth <= entry.section.size(); ++depth)
    {
      const bool last = depth == entry.section.size();
      const std::string &wanted = last ? entry.name : entry.section[depth];
      std::vector<std::string> allowed;
      for (const auto &item : node->items())
        if (is_entry(item.value()) == last)
          allowed.push_back(item.key());
      if (std::find(allowed.begin(), allowed.end(), wanted) == allowed.end())
      {
        std::string message = std::string("unknown ") +
                              (last ? "entry" : "subsection") + " \"" + wanted +
                              "\" in " + (above.empty() ? "the scene" : above);
        std::vector<std::string> elsewhere;
        if (last)
          find_entry(tree, wanted, "", elsewhere);
        if (!elsewhere.empty())
          message += "; an entry of this name belongs to " + elsewhere[0];
        else if (!allowed.empty())
          message +=
              "; did you mean \"" + nearest_name(wanted, allowed) + "\"?";
        if (!allowed.empty() && allowed.size() <= 30)
        {
          message += " Allowed here: ";
          for (std::size_t i = 0; i < allowed.size(); ++i)
            message += (i > 0 ? ", " : "") + allowed[i];
        }
        fail(entry.origin, path, message);
      }
      node = &(*node)[wanted];
      above += (above.empty() ? "" : "/") + wanted;
    }
    for (const std::string &section : entry.section)
      prm.enter_subsection(section);
    const bool accepted = prm.set(entry.name, entry.value);
    for (std::size_t i = 0; i < entry.section.size(); ++i)
      prm.leave_subsection();
    if (!accepted)
    {
      std::string right = node->value("pattern_description", "");
      const std::string selection = "[Selection ",
                        number_in = "[Integer range ";
      if (right.compare(0, selection.size(), selection) == 0)
        right = "one of " + right.substr(selection.size(),
                                         right.size() - selection.size() - 2);
      std::replace(right.begin(), right.end(), '|', ' ');
      fail(entry.origin, path,
           "\"" + path + "\" cannot be \"" + entry.value + "\": expected " +
               right);
    }
  }
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

void print_manual(const Parameters &prm, std::ostream &out)
{
  out << "# Parameters\n";
  print_section(declared_tree(prm), "", out);
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
