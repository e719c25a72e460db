// Small tools for text, shared by everything that reads or writes it.
#include "sabot/base/text.h"

#include <cctype>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace sabot
{
std::string trim(const std::string &text)
{
  const char *const blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank),
                    last = text.find_last_not_of(blank);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string &text, const char separator)
{
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);)
    parts.push_back(trim(part));
  return parts;
}

std::string join(const std::vector<std::string> &texts,
                 const std::string &between)
{
  std::string all;
  for (std::size_t i = 0; i < texts.size(); ++i)
    all += (i > 0 ? between : "") + texts[i];
  return all;
}

std::string lower_case(std::string text)
{
  for (char &c : text)
    c = std::tolower(static_cast<unsigned char>(c));
  return text;
}

std::string formatted(const char *pattern, const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
  return text;
}

std::optional<std::size_t> first_not_utf8(const std::string &text)
{
  const auto byte = [&](const std::size_t i) -> unsigned int
  { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  for (std::size_t i = 0; i < text.size();)
  {
    const unsigned int lead = byte(i);
    const int n_more = lead < 0x80                   ? 0
                       : lead >= 0xc2 && lead < 0xe0 ? 1
                       : lead >= 0xe0 && lead < 0xf0 ? 2
                       : lead >= 0xf0 && lead < 0xf5 ? 3
                                                     : -1;
    if (n_more < 0)
      return i;
    unsigned int code = n_more == 0 ? lead : lead & (0x3f >> n_more);
    for (int k = 1; k <= n_more; ++k)
    {
      if ((byte(i + k) & 0xc0) != 0x80)
        return i;
      code = code << 6 | (byte(i + k) & 0x3f);
    }
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    if (is_surrogate || code > 0x10ffff || (n_more == 2 && code < 0x800) ||
        (n_more == 3 && code < 0x10000))
      return i;
    i += 1 + n_more;
  }
  return std::nullopt;
}

std::string byte_not_utf8(const std::string &line)
{
  const auto at = first_not_utf8(line);
  if (!at)
    return "";
  char byte[8];
  std::snprintf(byte, sizeof(byte), "0x%02x",
                static_cast<unsigned char>(line[*at]));
  // Only what is before it can be shown.
  constexpr std::size_t most = 60;
  std::size_t first = *at > most ? *at - most : 0;
  while (first < *at &&
         (static_cast<unsigned char>(line[first]) & 0xc0) == 0x80)
    ++first;
  return "the byte " + std::string(byte) + " after \"" +
         (first > 0 ? "..." : "") + line.substr(first, *at - first) +
         "\" is not UTF-8 (a letter in Latin-1?)";
}

std::string replaced(std::string text, const std::string &part,
                     const std::string &other)
{
  for (std::size_t i = 0; (i = text.find(part, i)) != std::string::npos;
       i += other.size())
    text.replace(i, part.size(), other);
  return text;
}

std::vector<std::string> lines_of(const std::string &file)
{
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty())
      lines.push_back(line);
  return lines;
}
} // namespace sabot
