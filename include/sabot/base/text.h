#ifndef sabot_base_text_h
#define sabot_base_text_h

#include <optional>
#include <string>
#include <vector>

namespace sabot
{
// Nothing here knows of parameter files, units or locales.

/** @p text without blanks, tabs and line ends at both sides. */
std::string trim(const std::string &text);

/** The parts of @p text between characters @p separator, trimmed; some may be
    empty, but an empty text has none, and neither has what follows the last
    separator where nothing does: "a;;b;" has three. */
std::vector<std::string> split(const std::string &text, const char separator);

/** The parts of @p texts with @p between in between: join({"a", "b"}, "/") is
    "a/b", and nothing for no parts. */
std::string join(const std::vector<std::string> &texts,
                 const std::string &between);

/** @p text with its letters of ASCII in lower case. */
std::string lower_case(std::string text);

/** @p value as printf's @p pattern ("%.3g mm") has it: one conversion of a
    double, at most 63 characters in all. */
std::string formatted(const char *pattern, const double value);

/** Where the first byte stands that is not part of UTF-8 text; nothing where
    all are. Refuses overlong forms, surrogates and what is beyond U+10FFFF. */
std::optional<std::size_t> first_not_utf8(const std::string &text);

/** Which byte of @p line is not UTF-8, for messages; empty where all are. */
std::string byte_not_utf8(const std::string &line);

/** @p text with every @p part replaced by @p other. */
std::string replaced(std::string text, const std::string &part,
                     const std::string &other);

/** The lines of a file that are not empty; none of a file that cannot be
    read. */
std::vector<std::string> lines_of(const std::string &file);
} // namespace sabot

#endif
