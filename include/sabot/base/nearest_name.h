#ifndef sabot_base_nearest_name_h
#define sabot_base_nearest_name_h

#include <string>
#include <vector>

namespace sabot
{
/**
 * The entry of @p allowed that @p name was probably meant to be: of those that
 * are spelled like it the one with the least number of letters to insert,
 * delete or replace (Levenshtein 1966), upper and lower case alike; of several
 * the first. Spelled like it is what shares three letters of five, or is a part
 * of it, or has it as a part. Empty where nothing is like it.
 */
std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &allowed);

/** "; did you mean ...?" for the end of a message; empty where nothing is like
    @p name. */
std::string suggestion(const std::string &name,
                       const std::vector<std::string> &allowed);

/** The same; where nothing is like @p name what there is instead: "; there is:
    steel, copper". */
std::string suggestion_or_list(const std::string &name,
                               const std::vector<std::string> &allowed);

/** Throws InputError for the entry @p path: it names a @p what that is not
    among the @p allowed ones; suggests the nearest, or lists them. */
[[noreturn]] void throw_unknown_name(const std::string &path,
                                     const std::string &what,
                                     const std::string &name,
                                     const std::vector<std::string> &allowed);
} // namespace sabot

#endif
