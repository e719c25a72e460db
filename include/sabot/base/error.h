#ifndef sabot_base_error_h
#define sabot_base_error_h

#include <array>
#include <stdexcept>
#include <string>

namespace sabot
{
/**
 * What the process returns to the shell; what each means stands in
 * exit_code_meanings(), from which the reference is made.
 * Of an error on any rank all ranks return the same.
 */
enum class ExitCode : int
{
  done = 0,
  bad_input = 1,
  physics_failed = 2,
  interrupted = 3,
  io_failed = 4,
  no_memory = 5,
  program_fault = 6
};

/** A row of the reference's page on exit codes. */
struct ExitCodeMeaning
{
  ExitCode code;
  const char *meaning; // in sentences
};

/** What each exit code tells scripts that start the program: the program's own
    commands agree on it, so that a study or a shell may act on it without
    reading messages. By number. */
const std::array<ExitCodeMeaning, 7> &exit_code_meanings();

/**
 * Bad input, found while reading or checking a scene. @p parameter is the path
 * of the entry, e.g. "Bodies/plate/Size" (or empty); whoever has the file adds
 * name and line of it (ParameterFile::origin()). The message says what is
 * wrong, with the value that was found, and what would be right: one line.
 * Thrown on all ranks alike, before anything is written.
 */
class InputError : public std::runtime_error
{
public:
  InputError(const std::string &parameter, const std::string &message)
      : std::runtime_error(message), parameter(parameter)
  {
  }
  const std::string parameter;
};

/**
 * The run went wrong: not-a-number, energy blow-up, inversion. Ranks agree
 * first, so that all of them throw.
 * A run ends with ExitCode::physics_failed, its result and its last output
 * written; the message says what went wrong where, in one line, and the log
 * adds time and step.
 */
class PhysicsError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * A file could not be written or read; the message has the system's reason.
 * Collective functions throw it on all ranks when one had trouble.
 * ExitCode::io_failed. Nothing is tried again: what stood in the file before is
 * kept where files are written new and renamed.
 */
class IOError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * A signal asked to stop before there was a state to go on from: during the
 * set-up. Thrown on all ranks. ExitCode::interrupted.
 */
class StoppedEarly : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * Memory does not suffice; the message names what it was for and what the
 * process has (within_memory()). Thrown on the rank that met the limit, which
 * then has to end the others. ExitCode::no_memory.
 */
class MemoryError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};
} // namespace sabot

#endif
