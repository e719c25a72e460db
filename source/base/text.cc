// Small tools for text, shared by everything that reads or writes it.
#include "sabot/base/text.h"

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

std::string formatted(const char *pattern, const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
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
