#ifndef sabot_output_file_names_h
#define sabot_output_file_names_h

#include <string>

namespace sabot
{
/** @p name as part of a file's name: blanks, slashes and quotes as hyphens.
    Two bodies of one scene must differ in it, see check_names(). */
std::string file_name_of(std::string name);
} // namespace sabot

#endif
