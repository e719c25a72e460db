#ifndef sabot_base_error_h
#define sabot_base_error_h

#include <array>
#include <stdexcept>
#include <string>

namespace sabot
{
/** What the process returns to the shell; their meaning stands in
    exit_code_meanings. */
enum class ExitCode : int
{
  done = 0,
  bad_input = 1,
  physics_failed = 2,
  interrupted = 3,
  io_failed = 4
};

struct ExitCodeMeaning
{
  ExitCode code;
  const char *meaning;
};

/** What each exit code tells scripts, for the reference. */
inline constexpr std::array<ExitCodeMeaning, 5> exit_code_meanings = {{
    {ExitCode::done, "Done: the run reached its end, the scene is valid, all "
                     "checks passed."},
    {ExitCode::bad_input,
     "Bad input: a parameter file or the command line; nothing was run. The "
     "message names file, line and what would be right."},
    {ExitCode::physics_failed,
     "The run went wrong: not-a-number, energy balance, a collapsing step; or "
     "a run of a study or a check of `sabot verify` failed. `result.json` of a "
     "run says why."},
    {ExitCode::interrupted,
     "A signal (SIGINT, SIGTERM) stopped it; `sabot resume` or the same study "
     "again goes on."},
    {ExitCode::io_failed, "A file could not be written or read."},
}};

/**
 * Bad input, found while reading or checking a scene. @p parameter is the path
 * of the entry, e.g. "Bodies/plate/Size" (or empty); the reader adds file and
 * line.
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

/** The run went wrong: not-a-number, energy blow-up, inversion. Ranks agree
    first, so that all of them throw. */
class PhysicsError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** A file could not be written or read; the message has the system's reason.
    Collective functions throw it on all ranks when one had trouble. */
class IOError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};
} // namespace sabot

#endif
