// Reads parameter files with includes and overrides, and says where each entry
// comes from.
#include "sabot/base/parameter_file.h"

#include "sabot/base/declared_tree.h"
#include "sabot/base/entry_aliases.h"
#include "sabot/base/expected_value.h"
#include "sabot/base/text.h"
#include "sabot/base/unknown_entry.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace sabot
{
namespace
{
using nlohmann::ordered_json;

/** "Section/Sub/Name"; an empty name gives the path of the section. */
std::string path_of(const std::vector<std::string> &section,
                    const std::string &name = "")
{
  const std::string path = join(section, "/");
  return path.empty() || name.empty() ? path + name : path + "/" + name;
}

std::string folder_of(const std::string &file)
{
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "" : file.substr(0, slash + 1);
}

[[noreturn]] void fail(const std::string &origin, const std::string &path,
                       const std::string &message)
{
  throw InputError(path, (origin.empty() ? "" : origin + ": ") + message);
}

/** A line without comment, with those that continue it, and the number of its
    first. */
struct Line
{
  unsigned int number;
  std::string text;
};

/** The text of @p file with line ends and blanks as they are here, whatever
    editor has saved it. */
std::string read_text(const std::string &file, const std::string &included_at)
{
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open() || std::filesystem::is_directory(file, ignored))
    fail(included_at, "",
         "cannot read parameter file \"" + file +
             "\"; check its name and that it is a readable text file");
  constexpr std::size_t longest = std::size_t(64) << 20; // /dev/zero, a mesh
  std::string text, piece(std::size_t(1) << 16, '\0');
  while (text.size() <= longest &&
         stream.read(&piece[0], piece.size()).gcount())
    text.append(piece, 0, stream.gcount());
  if (text.size() > longest)
    fail(included_at, "",
         "parameter file \"" + file +
             "\" has more than 64 MB; is it a scene, or a file of results?");
  const auto begins_with = [&](const std::string &mark)
  { return text.compare(0, mark.size(), mark) == 0; };
  if (begins_with("\xff\xfe") || begins_with("\xfe\xff") ||
      text.find('\0') != std::string::npos)
    fail(file, "",
         "is no text in UTF-8 but in UTF-16, or binary; save it as UTF-8");
  const std::string byte_order_mark = "\xef\xbb\xbf";
  if (begins_with(byte_order_mark))
    text.erase(0, byte_order_mark.size());
  text = replaced(replaced(std::move(text), "\r\n", "\n"), "\r", "\n");
  for (const std::string blank : {"\u00a0", "\u2009", "\u202f"})
    text = replaced(std::move(text), blank, " ");
  return text;
}

/** InputError where @p text is not UTF-8: nothing that reads the results could
    read it. */
void check_encoding(const std::string &origin, const std::string &text)
{
  const std::string byte = byte_not_utf8(text);
  if (!byte.empty())
    fail(origin, "", byte + "; save the file as UTF-8");
}

/** Whether all entries are written out, as print_expanded() does. */
bool is_listing(const std::string &content)
{
  const std::size_t title = content.find("# Listing of Parameters\n");
  return title != std::string::npos && title < content.find("\nset ");
}

/** The lines of @p file, with this @p content, that say something. */
std::vector<Line> read_lines(const std::string &file,
                             const std::string &content)
{
  std::stringstream stream(content);
  std::vector<Line> lines;
  std::string line;
  for (unsigned int n = 1; std::getline(stream, line); ++n)
  {
    const unsigned int first = n;
    std::string text = trim(line.substr(0, line.find('#')));
    while (!text.empty() && text.back() == '\\')
    {
      text.pop_back();
      if (!std::getline(stream, line))
        break;
      ++n;
      text = trim(text + trim(line.substr(0, line.find('#'))));
    }
    text = trim(text);
    if (text.empty())
      continue;
    check_encoding(file + ":" + std::to_string(first), text);
    lines.push_back({first, text});
  }
  return lines;
}

/** Name and value around the first "=" of @p text; the name is empty where
    there is none. */
std::pair<std::string, std::string> assignment(const std::string &text)
{
  const std::size_t equals = text.find('=');
  return equals == std::string::npos
             ? std::pair<std::string, std::string>()
             : std::make_pair(trim(text.substr(0, equals)),
                              trim(text.substr(equals + 1)));
}

} // namespace

ParameterFile::ParameterFile(const std::string &file,
                             const std::vector<std::string> &overrides,
                             const std::vector<OverrideOrigin> &origins)
    : file_name(file)
{
  std::vector<std::string> section, open_files;
  read(file, "", section, open_files);
  for (std::size_t i = 0; i < overrides.size(); ++i)
  {
    const std::string option = "--set \"" + overrides[i] + "\"";
    override_by(overrides[i], i < origins.size()
                                  ? origins[i]
                                  : OverrideOrigin{option, option});
  }
}

void ParameterFile::override_by(const std::string &text,
                                const OverrideOrigin &origin)
{
  check_encoding(origin.value, text);
  const auto [path, value] = assignment(text);
  if (path.empty())
    fail(origin.entry, "",
         "expected \"Section/Name=value\", for example \"End time=2 us\"");
  SetEntry entry;
  entry.section = split(path, '/');
  entry.name = entry.section.back();
  entry.section.pop_back();
  entry.value = value;
  entry.origin = origin.value;
  entry.named_at = origin.entry;
  add(entry);
}

void ParameterFile::read(const std::string &file,
                         const std::string &included_at,
                         std::vector<std::string> &section,
                         std::vector<std::string> &open_files)
{
  std::error_code ignored;
  const std::string known_as =
      std::filesystem::weakly_canonical(file, ignored).string();
  if (std::find(open_files.begin(), open_files.end(), known_as) !=
      open_files.end())
    fail(included_at, "", "file \"" + file + "\" includes itself");
  // What several files of a family include says the same each time.
  if (!included.insert({path_of(section), known_as}).second)
    return;
  const std::string content = read_text(file, included_at);
  if (is_listing(content))
    listings.insert(file);
  const std::vector<Line> lines = read_lines(file, content);
  open_files.push_back(known_as);
  const std::size_t depth = section.size();
  std::vector<std::string> opened; // origin of each open subsection
  for (const Line &line : lines)
  {
    const std::string &text = line.text;
    const std::string origin = file + ":" + std::to_string(line.number);
    const std::size_t blank = text.find_first_of(" \t");
    const std::string word = text.substr(0, blank);
    const std::string rest =
        blank == std::string::npos ? "" : trim(text.substr(blank));
    if (word == "subsection" && !rest.empty())
    {
      section.push_back(rest);
      opened.push_back(origin);
      const std::string path = path_of(section);
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
      const auto [name, value] = assignment(rest);
      if (name.empty())
        fail(origin, path_of(section),
             "expected \"set Name = value\", found \"" + text + "\"");
      // The apostrophe of typographers, as in Young's modulus.
      add({section, replaced(name, "\u2019", "'"), value, origin, file});
    }
    else if (word == "include" && !rest.empty())
      read(rest[0] == '/' ? rest : folder_of(file) + rest, origin, section,
           open_files);
    else
      fail(origin, path_of(section),
           "expected set, subsection, end or include, found \"" + text + "\"");
  }
  if (!opened.empty())
    fail(opened.back(), path_of(section),
         "subsection \"" + section.back() + "\" has no \"end\"");
  open_files.pop_back();
}

void ParameterFile::add(const SetEntry &given)
{
  SetEntry entry = given;
  entry.name = present_name(given.name);
  if (entry.name != given.name)
  {
    const std::string note = "\"" + given.name + "\" is now called \"" +
                             entry.name + "\" (" + given.origin + ")";
    if (renamed.insert(given.name).second)
      said.push_back(note);
  }
  const std::string path = path_of(entry.section, entry.name);
  const auto known = number.find(path);
  if (known == number.end())
  {
    number[path] = entries.size();
    entries.push_back(entry);
    return;
  }
  SetEntry &old = entries[known->second];
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
  for (const SetEntry &entry : entries)
    if (!entry.section.empty())
      consider(path_of(entry.section));
  return names;
}

bool ParameterFile::is_set(const std::string &path) const
{
  return number.count(path) > 0;
}

bool ParameterFile::is_chosen(const std::string &path) const
{
  const auto found = number.find(path);
  return found != number.end() &&
         listings.count(entries[found->second].file) == 0;
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

std::string ParameterFile::file_of(const std::string &path) const
{
  const auto found = number.find(path);
  return found == number.end() || entries[found->second].file.empty()
             ? file_name
             : entries[found->second].file;
}

std::string ParameterFile::located(const InputError &error) const
{
  const std::string message = error.what();
  if (error.parameter.empty())
    return message;
  const std::string from = origin(error.parameter);
  const auto begins_with = [&](const std::string &place)
  { return !place.empty() && message.compare(0, place.size(), place) == 0; };
  const auto found = number.find(error.parameter);
  if (begins_with(from) ||
      (found != number.end() && begins_with(entries[found->second].named_at)))
    return message;
  return from + ": " + error.parameter + ": " + message;
}

void ParameterFile::parse_into(
    Parameters &prm, const std::function<void(Parameters &)> &declare_all) const
{
  const ordered_json tree = declared_tree(prm);
  for (const SetEntry &entry : entries)
  {
    const std::string path = path_of(entry.section, entry.name);
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
        fail(entry.named_at.empty() ? entry.origin : entry.named_at, path,
             about_unknown_entry({tree, above, wanted, last}, allowed,
                                 declare_all));
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
      fail(entry.origin, path,
           "\"" + path + "\" cannot be \"" + entry.value + "\": expected " +
               expected_value(node->value("pattern_description", ""),
                              entry.value));
    }
  }
}
} // namespace sabot
