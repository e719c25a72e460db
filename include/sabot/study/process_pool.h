#ifndef sabot_study_process_pool_h
#define sabot_study_process_pool_h

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace sabot
{
/** A program with its arguments; what it says on both its outputs goes to
    @p log. */
struct Command
{
  std::vector<std::string> words; // the first is looked up on the PATH
  std::string log;                // file, emptied first
  int descriptor = -1;            // stays open in the program; -1: none
  int stop_signal = SIGTERM;      // asks it to come to an end
};

/** How a process ended: its exit code, or minus the signal that ended it. */
struct Ended
{
  std::size_t command; // its index
  int code;            // 0: well
};

/** When a command is to be started. */
enum class Readiness
{
  now,
  later, // to be asked again
  never
};

/** Says whose turn it is and makes the command of that number. */
using Prepare = std::function<Readiness(std::size_t number, Command &command)>;

/**
 * Run @p n commands as processes of their own, up to @p n_processes at a time,
 * in order as far as their turns allow, and report each end. Stop signals
 * (stop_signals.h) are passed on to those that run, as what ends them, every
 * two seconds, as an mpirun loses them while it starts; no further ones are
 * started, and those that run are waited for. Should this process be killed,
 * the system sends them SIGTERM. The processes must not be started from one
 * that uses MPI. IOError when one cannot be started. @return whether all had
 * their turn and nobody asked to stop.
 */
bool run_processes(const std::size_t n, const unsigned int n_processes,
                   const Prepare &prepare,
                   const std::function<void(const Ended &)> &report);

/** Path of the running program, however it was called (Linux). */
std::string own_program();
/** Whether a program of this name, without folder, is on the PATH and may be
    run. */
bool is_on_path(const std::string &program);
} // namespace sabot

#endif
