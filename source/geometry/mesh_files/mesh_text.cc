// Words and numbers of mesh files, none of them trusted.
#include "sabot/geometry/mesh_text.h"

#include "sabot/base/text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sys/stat.h>

namespace sabot
{
namespace
{
bool is_blank(const char c)
{
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0' ||
         c == '\v' || c == '\f';
}

/** from_chars() takes no plus sign. */
std::string_view without_plus(std::string_view word)
{
  if (word.size() > 1 && word[0] == '+' && word[1] != '-')
    word.remove_prefix(1);
  return word;
}

/** Length of the character of UTF-8 that begins at @p at; 0: there is none. */
std::size_t length_of_character(const std::string &text, const std::size_t at)
{
  const unsigned char first = text[at];
  const std::size_t n = first < 0x80                    ? 1
                        : first >= 0xC2 && first < 0xE0 ? 2
                        : first >= 0xE0 && first < 0xF0 ? 3
                        : first >= 0xF0 && first < 0xF5 ? 4
                                                        : 0;
  bool is_whole = n > 0 && at + n <= text.size();
  for (std::size_t i = 1; is_whole && i < n; ++i)
    is_whole = (static_cast<unsigned char>(text[at + i]) & 0xC0) == 0x80;
  return is_whole ? n : 0;
}

/** Lone carriage returns, which end the lines of some editors, become line
    feeds; what has null bytes is binary and stays. */
void end_lines_here(std::string &text)
{
  if (text.find('\0') != std::string::npos)
    return;
  for (std::size_t at = text.find('\r'); at != std::string::npos;
       at = text.find('\r', at + 1))
    if (at + 1 == text.size() || text[at + 1] != '\n')
      text[at] = '\n';
}

std::string quoted(const std::string_view word)
{
  constexpr std::size_t most = 40;
  return "\"" + std::string(word.substr(0, most)) +
         (word.size() > most ? "...\"" : "\"");
}
} // namespace

std::optional<std::int64_t> whole_number(std::string_view word)
{
  word = without_plus(word);
  std::int64_t value = 0;
  const auto end = word.data() + word.size();
  const auto found = std::from_chars(word.data(), end, value);
  if (word.empty() || found.ec != std::errc() || found.ptr != end)
    return std::nullopt;
  return value;
}

std::optional<double> real_number(std::string_view word)
{
  word = without_plus(word);
  std::string changed;
  if (word.find_first_of("dD") != std::string_view::npos)
  {
    changed = word;
    for (char &c : changed)
      c = c == 'd' || c == 'D' ? 'e' : c;
    word = changed;
  }
  double value = 0.;
  const auto end = word.data() + word.size();
  const auto found = std::from_chars(word.data(), end, value);
  if (word.empty() || found.ec != std::errc() || found.ptr != end ||
      !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string printable(const std::string &text)
{
  constexpr std::size_t most = 1000;
  std::string shown;
  for (std::size_t at = 0; at < text.size() && at < most;)
  {
    const std::size_t n = length_of_character(text, at);
    const bool is_control = n == 1 && (text[at] < ' ' || text[at] == 127);
    shown += n == 0 || is_control ? "?" : text.substr(at, n);
    at += std::max<std::size_t>(n, 1);
  }
  return shown;
}

void MeshFile::refuse(const std::string &why, const std::size_t line) const
{
  throw InputError(
      path, "cannot read the mesh file \"" + name + "\"" +
                (line > 0 ? ", line " + std::to_string(line) : std::string()) +
                ": " + printable(why));
}

void MeshFile::check_encoding(const std::string &line,
                              const std::size_t number) const
{
  const std::string byte = byte_not_utf8(line);
  if (!byte.empty())
    refuse(byte + "; save the file as UTF-8", number);
}

std::string MeshFile::text() const
{
  struct stat status = {};
  if (stat(name.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw InputError(path, "\"" + name + "\" is no file");
  std::ifstream stream(name, std::ios::binary);
  if (!stream)
    throw InputError(path, "cannot open the mesh file \"" + name +
                               "\": " + std::strerror(errno));
  std::string all(status.st_size, '\0');
  stream.read(&all[0], all.size());
  all.resize(stream.gcount());
  if (trim(all).empty())
    refuse("it is empty");
  if (all.compare(0, 2, "\xff\xfe") == 0 || all.compare(0, 2, "\xfe\xff") == 0)
    refuse("it is no text in UTF-8 but in UTF-16; save it as UTF-8");
  end_lines_here(all);
  return all;
}

bool MeshText::at_end()
{
  while (at < all.size() && is_blank(all[at]))
    ++at;
  return at == all.size();
}

std::string_view MeshText::word()
{
  if (at_end())
    refuse("it ends before it is complete");
  const std::size_t first = at;
  while (at < all.size() && !is_blank(all[at]))
    ++at;
  return std::string_view(all).substr(first, at - first);
}

std::string_view MeshText::line()
{
  const std::size_t first = at;
  at = std::min(all.find('\n', at), all.size());
  std::string_view found = std::string_view(all).substr(first, at - first);
  at = std::min(at + 1, all.size());
  while (!found.empty() && is_blank(found.back()))
    found.remove_suffix(1);
  while (!found.empty() && is_blank(found.front()))
    found.remove_prefix(1);
  return found;
}

std::int64_t MeshText::integer()
{
  const std::string_view found = word();
  const auto value = whole_number(found);
  if (!value)
    refuse(quoted(found) + " stands where a whole number should");
  return *value;
}

double MeshText::real()
{
  const std::string_view found = word();
  const auto value = real_number(found);
  if (!value)
    refuse(quoted(found) + " stands where a number should");
  return *value;
}

std::size_t MeshText::count(const std::size_t bytes)
{
  const std::int64_t n = integer();
  if (n < 0)
    refuse("the count " + std::to_string(n) + " is negative");
  expect(n, bytes);
  return n;
}

void MeshText::expect(const std::uint64_t n, const std::size_t bytes)
{
  if (bytes > 0 && n > (all.size() - at) / bytes)
    refuse(n == 1 ? "it ends before it is complete"
                  : "it announces " + std::to_string(n) +
                        " entries, but ends before there can be as many");
}

void MeshText::skip_behind(const std::string &mark)
{
  while (at < all.size())
  {
    const std::size_t found = all.find(mark, at);
    if (found == std::string::npos)
      break;
    at = found + mark.size();
    if (found == 0 || all[found - 1] == '\n')
      return;
  }
  at = all.size();
  refuse("the line " + mark + " is missing");
}

std::size_t MeshText::line_number() const
{
  const std::size_t end = at > 0 ? at - 1 : 0;
  return 1 + std::count(all.begin(), all.begin() + end, '\n');
}

void MeshText::check_encoding(const std::string_view found) const
{
  file.check_encoding(std::string(found), line_number());
}

void MeshText::refuse(const std::string &why) const
{
  file.refuse(why, line_number());
}
} // namespace sabot
