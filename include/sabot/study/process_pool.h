#ifndef sabot_study_process_pool_h
#define sabot_study_process_pool_h

#include <functional>
#include <string>
#include <vector>

namespace sabot
{
/** A program with its arguments; what it says goes to @p log. */
struct Command
{
  std::vector<std::string> words;
  std::string log;
};

/** How a process ended: its exit code, or minus the signal that ended it. */
struct Ended
{
  std::size_t command;
  int code;
};

/**
 * Run commands as processes of their own, up to @p n_processes at a time, in
 * order, and report each end. SIGINT and SIGTERM are passed on to those that
 * run; no further ones are started. @return whether all were started.
 */
bool run_processes(const std::vector<Command> &commands,
                   const unsigned int n_processes,
                   const std::function<void(const Ended &)> &report);

/** Path of the running program. */
std::string own_program();
/** Whether a program of this name is on the PATH. */
bool is_on_path(const std::string &program);
} // namespace sabot

#endif
