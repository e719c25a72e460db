#ifndef sabot_study_process_pool_h
#define sabot_study_process_pool_h

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
};

/** How a process ended: its exit code, or minus the signal that ended it. */
struct Ended
{
  std::size_t command; // its index
  int code;            // 0: well
};

/**
 * Run commands as processes of their own, up to @p n_processes at a time, in
 * order, and report each end. SIGINT and SIGTERM are passed on to those that
 * run, once; no further ones are started, and those that run are waited for.
 * The processes must not be started from one that uses MPI. IOError when one
 * cannot be started. @return whether all were started and nobody asked to
 * stop.
 */
bool run_processes(const std::vector<Command> &commands,
                   const unsigned int n_processes,
                   const std::function<void(const Ended &)> &report);

/** Path of the running program, however it was called (Linux). */
std::string own_program();
/** Whether a program of this name, without folder, is on the PATH and may be
    run. */
bool is_on_path(const std::string &program);
} // namespace sabot

#endif
