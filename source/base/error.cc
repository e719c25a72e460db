// What the exit codes mean.
#include "sabot/base/error.h"

namespace sabot
{
const std::array<ExitCodeMeaning, 7> &exit_code_meanings()
{
  static const std::array<ExitCodeMeaning, 7> meanings = {{
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
       "A signal (SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2) stopped "
       "it; `sabot resume`, or the same study again, goes on. Where it came "
       "during the set-up nothing has been run yet."},
      {ExitCode::io_failed,
       "A file could not be written or read, or its folder is gone, another "
       "one now, or in use by another run."},
      {ExitCode::no_memory,
       "Memory did not suffice; the message says for what."},
      {ExitCode::program_fault,
       "The program is at fault: what went wrong was not foreseen."},
  }};
  return meanings;
}
} // namespace sabot
