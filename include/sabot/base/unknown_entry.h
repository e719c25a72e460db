#ifndef sabot_base_unknown_entry_h
#define sabot_base_unknown_entry_h

#include "sabot/base/parameters.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace sabot
{
/** An entry or subsection that is set and not declared. */
struct UnknownEntry
{
  const nlohmann::ordered_json &tree; // all that is declared
  const std::string &above;           // its section; "": the top level
  const std::string &name;
  bool is_entry; // else a subsection
};

/** The line for it: where an entry of this name belongs, or which of those that
    are @p allowed there was meant. @p declare_all: see
    ParameterFile::parse_into(). */
std::string
about_unknown_entry(const UnknownEntry &unknown,
                    const std::vector<std::string> &allowed,
                    const std::function<void(Parameters &)> &declare_all);
} // namespace sabot

#endif
