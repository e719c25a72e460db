// Abaqus decks as keywords with options and lines of data.
#include "sabot/geometry/abaqus_deck.h"

#include "sabot/base/text.h"

#include <algorithm>
#include <cctype>

namespace sabot
{
namespace
{
std::string_view trimmed(std::string_view text)
{
  constexpr const char *blanks = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/** The next line from @p at, which then stands at the one after. */
std::string_view next_line(const std::string_view text, std::size_t &at)
{
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = text.substr(at, end - at);
  at = end + 1;
  return trimmed(line);
}

bool is_comment(const std::string_view line)
{
  return line.substr(0, 2) == "**";
}

/** Whether a file that is included behind it may begin with more of its
    lines. */
bool takes_data(const AbaqusBlock &block)
{
  const std::string &word = block.keyword;
  return word == "NODE" || word == "ELEMENT" || word == "NSET" ||
         word == "ELSET" || word == "SURFACE";
}

/** "*Solid Section" as "SOLIDSECTION". */
std::string without_blanks(const std::string &text)
{
  std::string packed;
  for (const char c : text)
    if (!std::isspace(static_cast<unsigned char>(c)))
      packed += c;
  return packed;
}

std::string unquoted(const std::string &text)
{
  return text.size() > 1 && text.front() == '"' && text.back() == '"'
             ? text.substr(1, text.size() - 2)
             : text;
}
} // namespace

std::string upper_case(std::string text)
{
  for (char &c : text)
    c = std::toupper(static_cast<unsigned char>(c));
  return text;
}

AbaqusDeck::AbaqusDeck(const MeshFile &file)
{
  read(file, 0);
}

void AbaqusDeck::read(const MeshFile &file, const int depth)
{
  const std::size_t file_number = files.size();
  files.push_back(file);
  texts.push_back(file.text());
  std::string_view text = texts.back();
  if (text.substr(0, 3) == "\xEF\xBB\xBF") // a byte order mark
    text.remove_prefix(3);
  const std::size_t first_block = blocks.size();
  std::size_t at = 0, number = 0;
  while (at < text.size())
  {
    const std::string_view line = next_line(text, at);
    ++number;
    check_encoding(file, line, number,
                   is_comment(line) ||
                       (line.substr(0, 1) != "*" && !blocks.empty() &&
                        blocks.back().keyword == "HEADING"));
    if (line.empty() || is_comment(line))
      continue;
    if (line[0] != '*')
    {
      if (blocks.empty() ||
          (blocks.size() == first_block && !takes_data(blocks.back())))
        file.refuse("text stands before the first keyword (as *Node)", number);
      if (blocks.back().file != file_number)
        go_on(file_number, number);
      blocks.back().lines.push_back(line);
      blocks.back().numbers.push_back(number);
      continue;
    }
    add_keyword(std::string(line), text, at, number, file_number);
    if (blocks.back().keyword != "INCLUDE")
      continue;
    const AbaqusBlock include = blocks.back();
    blocks.pop_back();
    if (depth == 8 || files.size() > 1000)
      refuse("files include each other too deeply", include);
    std::string name = include.option("INPUT");
    const std::size_t slash = file.name.find_last_of('/');
    if (name.empty())
      refuse("*Include needs INPUT=FILE", include);
    if (name[0] != '/' && slash != std::string::npos)
      name = file.name.substr(0, slash + 1) + name;
    read({name, file.path}, depth + 1);
  }
}

void AbaqusDeck::check_encoding(const MeshFile &file,
                                const std::string_view line,
                                const std::size_t number,
                                const bool is_passed_over)
{
  if (std::none_of(line.begin(), line.end(),
                   [](const char c)
                   { return static_cast<unsigned char>(c) > 127; }))
    return;
  if (!is_passed_over)
    return file.check_encoding(std::string(line), number);
  const std::string byte =
      noted == file.name ? "" : byte_not_utf8(std::string(line));
  if (byte.empty())
    return;
  noted = file.name;
  notes.push_back("\"" + file.name + "\", line " + std::to_string(number) +
                  ": " + byte +
                  "; it is passed over, as in all comments and "
                  "headings");
}

void AbaqusDeck::go_on(const std::size_t file_number, const std::size_t number)
{
  AbaqusBlock more;
  more.shown = blocks.back().shown;
  more.keyword = blocks.back().keyword;
  more.options = blocks.back().options;
  more.file = file_number;
  more.line = number;
  blocks.push_back(std::move(more));
}

void AbaqusDeck::add_keyword(std::string line, const std::string_view text,
                             std::size_t &at, std::size_t &number,
                             const std::size_t file_number)
{
  AbaqusBlock block;
  block.file = file_number;
  block.line = number;
  while (!line.empty() && line.back() == ',' && at < text.size())
  {
    std::size_t after = at;
    const std::string_view more = next_line(text, after);
    // A comma too many: what follows are numbers or the next keyword.
    const bool is_option =
        is_comment(more) ||
        (!more.empty() && std::isalpha(static_cast<unsigned char>(more[0])));
    if (!is_option)
      break;
    at = after;
    ++number;
    check_encoding(files[file_number], more, number, is_comment(more));
    if (!is_comment(more))
      line += more;
  }
  const std::vector<std::string> parts = split(line, ',');
  block.shown = parts[0];
  block.keyword = upper_case(without_blanks(parts[0].substr(1)));
  for (std::size_t p = 1; p < parts.size(); ++p)
  {
    const std::size_t equals = parts[p].find('=');
    const std::string name = upper_case(trim(parts[p].substr(0, equals)));
    block.options[name] = equals == std::string::npos
                              ? ""
                              : unquoted(trim(parts[p].substr(equals + 1)));
  }
  blocks.push_back(std::move(block));
}

AbaqusRow AbaqusDeck::row(const AbaqusBlock &block, const std::size_t i) const
{
  AbaqusRow row;
  row.file = block.file;
  row.line = block.numbers[i];
  std::string_view rest = block.lines[i];
  row.goes_on = rest.back() == ',';
  while (true)
  {
    const std::size_t comma = rest.find(',');
    row.parts.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos)
      break;
    rest.remove_prefix(comma + 1);
  }
  if (row.parts.back().empty())
    row.parts.pop_back();
  return row;
}

void AbaqusDeck::refuse(const std::string &why, const AbaqusBlock &at) const
{
  files[at.file].refuse(why, at.line);
}

void AbaqusDeck::refuse(const std::string &why, const AbaqusRow &at) const
{
  files[at.file].refuse(why, at.line);
}
} // namespace sabot
