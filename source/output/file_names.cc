// What the names of a scene are as names of files.
#include "sabot/output/file_names.h"

namespace sabot
{
std::string file_name_of(std::string name)
{
  for (char &c : name)
    if (c == '/' || c == ' ' || c == '"')
      c = '-';
  return name;
}
} // namespace sabot
