# Writes FILE with the revision of the sources in ROOT, where it has changed:
# cmake -D ROOT=... -D FILE=... -P revision.cmake
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude=*
  WORKING_DIRECTORY ${ROOT} OUTPUT_VARIABLE revision ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed OR revision STREQUAL "")
  set(revision "unknown")
endif()
set(text "// The revision that the program is built from.
#include <string>

namespace sabot
{
std::string source_revision()
{
  return \"${revision}\";
}
} // namespace sabot
")
if(EXISTS ${FILE})
  file(READ ${FILE} present)
endif()
if(NOT "${present}" STREQUAL "${text}")
  file(WRITE ${FILE} "${text}")
endif()
