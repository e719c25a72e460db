#ifndef sabot_base_entry_aliases_h
#define sabot_base_entry_aliases_h

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Names that entries of parameter files had in earlier versions, each with the
 * name that it has now, whatever the subsection. They stay accepted, in files,
 * in --set and in the entries of studies: ParameterFile turns them into the
 * present names as it reads, so that nothing else has to know them, and says
 * so once for each (ParameterFile::notes()).
 *
 * Old name first. To rename an entry, rename it where it is declared and add a
 * pair here.
 */
const std::vector<std::pair<std::string, std::string>> &entry_aliases();

/** The present name of an entry: @p name itself, unless it is an old one. */
std::string present_name(const std::string &name);
} // namespace sabot

#endif
