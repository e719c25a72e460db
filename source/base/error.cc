// What the exit codes mean.
#include "sabot/base/error.h"

namespace sabot
{
const std::array<ExitCodeMeaning, 5> &exit_code_meanings()
{
  static const std::array<ExitCodeMeaning, 5> meanings = {{
      {ExitCode::done, "Done: the run reached its end, the scene is valid, all "
                       "checks passed."},
      {ExitCode::bad_input,
       "Bad input: a parameter file or the command line; nothing was run. The "
       "message names file, line and what would be right."},
      {ExitCode::physics_failed,
       "The run went wrong: not-a-number, energy balance, a collapsing step; "
       "or a run of a study or a check of `sabot verify` failed. "
       "`result.json` of a run says why."},
      {ExitCode::interrupted,
       "A signal (SIGINT, SIGTERM) stopped it; `sabot resume`, or the same "
       "study again, goes on."},
      {ExitCode::io_failed, "A file could not be written or read."},
  }};
  return meanings;
}
} // namespace sabot
