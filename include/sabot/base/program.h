#ifndef sabot_base_program_h
#define sabot_base_program_h

#include <string>

namespace sabot
{
/**
 * What a record of a run says of the program that made it. The program's main()
 * fills command and revision at its start; tests leave them empty.
 */
struct ProgramFacts
{
  std::string command;  // as a shell would take it again
  std::string revision; // of the sources, "-dirty" where they were changed
};
/** Of this process. */
ProgramFacts &program_facts();

/** The words of a command line, quoted where a shell would split them. */
std::string command_text(const int argc, const char *const *argv);

/** Compiler and instruction set: "GNU 12.2.0, instruction set native
    (AVX-512)". Bits of results may differ between two of them. */
std::string build_text();

/** Date and time of day, UTC, and the name of this machine. */
std::string place_text();
} // namespace sabot

#endif
