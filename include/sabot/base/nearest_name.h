#ifndef sabot_base_nearest_name_h
#define sabot_base_nearest_name_h

#include <string>
#include <vector>

namespace sabot
{
/**
 * The entry of @p allowed (not empty) with the least distance to @p name: the
 * least number of letters to insert, delete or replace (Levenshtein 1966),
 * upper and lower case alike; of several the first. For "did you mean ...?" of
 * messages: there is an answer however far it is.
 */
std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &allowed);

/** Throws InputError for the entry @p path: it names a @p what that is not
    among the @p allowed ones; suggests the nearest. */
[[noreturn]] void throw_unknown_name(const std::string &path,
                                     const std::string &what,
                                     const std::string &name,
                                     const std::vector<std::string> &allowed);
} // namespace sabot

#endif
