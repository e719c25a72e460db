#ifndef sabot_base_nearest_name_h
#define sabot_base_nearest_name_h

#include <string>
#include <vector>

namespace sabot
{
/** The entry of @p allowed (not empty) with the least edit distance to
    @p name, upper and lower case alike. */
std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &allowed);
} // namespace sabot

#endif
