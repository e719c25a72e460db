#ifndef sabot_base_entry_aliases_h
#define sabot_base_entry_aliases_h

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** Names that entries of parameter files had in earlier versions, each with
    the name that it has now, whatever the subsection. They stay accepted. */
const std::vector<std::pair<std::string, std::string>> &entry_aliases();

/** The present name of an entry: @p name itself, unless it is an old one. */
std::string present_name(const std::string &name);
} // namespace sabot

#endif
