// Runs programs, several at a time.
#include "sabot/study/process_pool.h"

#include "sabot/base/error.h"
#include "sabot/base/stop_signals.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <map>
#include <sstream>

namespace sabot
{
namespace
{
/** Stop signals and ends of processes wait until they are asked for: none comes
    between a look and the wait that follows it. */
class SignalsHeld
{
public:
  SignalsHeld()
  {
    std::signal(SIGCHLD, SIG_DFL); // else ends would not be told
    sigemptyset(&held);
    sigaddset(&held, SIGCHLD);
    for (const int signal : noted_stop_signals())
      sigaddset(&held, signal);
    sigprocmask(SIG_BLOCK, &held, &before);
  }
  ~SignalsHeld() { sigprocmask(SIG_SETMASK, &before, nullptr); }

  /** Wait for one, but not long. @return whether it asks to stop. */
  bool wait() const
  {
    constexpr timespec most = {0, 300000000}; // [s], [ns]
    const int signal = sigtimedwait(&held, nullptr, &most);
    return signal > 0 && signal != SIGCHLD;
  }

  sigset_t held, before;
};

/** In the new process: become the program. What fails goes to @p report. */
[[noreturn]] void become(const Command &command, char *const *words,
                         const sigset_t &signals, const pid_t parent,
                         const int report)
{
  // A group of its own: a Ctrl-C at the terminal reaches it through us, once.
  setpgid(0, 0);
  sigprocmask(SIG_SETMASK, &signals, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) // which was killed in between
    _exit(127);
  const int nothing = open("/dev/null", O_RDONLY),
            log = open(command.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (nothing >= 0 && log >= 0)
  {
    dup2(nothing, STDIN_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    if (command.descriptor >= 0)
      fcntl(command.descriptor, F_SETFD, 0);
    execvp(words[0], words);
  }
  const int error = errno;
  if (write(report, &error, sizeof(error)) < 0)
    _exit(126);
  _exit(127);
}

pid_t start(const Command &command, const SignalsHeld &signals)
{
  std::vector<char *> words;
  for (const std::string &word : command.words)
    words.push_back(const_cast<char *>(word.c_str()));
  words.push_back(nullptr);
  // Closes by itself when the program has started.
  int report[2] = {-1, -1};
  const pid_t parent = getpid();
  int error = pipe2(report, O_CLOEXEC) == 0 ? 0 : errno;
  const pid_t pid = error == 0 ? fork() : -1;
  if (pid == 0)
    become(command, words.data(), signals.before, parent, report[1]);
  if (pid < 0 && error == 0)
    error = errno;
  for (int *const end : {&report[1], &report[0]})
  {
    if (end == &report[0] && pid > 0 &&
        read(*end, &error, sizeof(error)) != sizeof(error))
      error = 0;
    close(*end);
  }
  if (error != 0)
  {
    if (pid > 0)
      waitpid(pid, nullptr, 0);
    throw IOError("cannot start \"" + command.words[0] +
                  "\": " + std::strerror(error));
  }
  return pid;
}

/** Processes that run: number of the command, and what ends it. */
struct Process
{
  std::size_t number;
  int stop_signal;
};
using Running = std::map<pid_t, Process>;

/** Start those of @p waiting whose turn it is. */
void start_some(std::deque<std::size_t> &waiting, Running &running,
                const unsigned int n_processes, const Prepare &prepare,
                const SignalsHeld &signals)
{
  const std::size_t n = waiting.size();
  for (std::size_t w = 0; w < n && running.size() < n_processes; ++w)
  {
    const std::size_t number = waiting.front();
    waiting.pop_front();
    Command command;
    const Readiness turn = prepare(number, command);
    if (turn == Readiness::now)
      running[start(command, signals)] = {number, command.stop_signal};
    else if (turn == Readiness::later)
      waiting.push_back(number);
  }
}

/** Report those that have ended. */
void report_ended(Running &running,
                  const std::function<void(const Ended &)> &report)
{
  for (auto process = running.begin(); process != running.end();)
  {
    int status = 0;
    const pid_t pid = waitpid(process->first, &status, WNOHANG);
    if (pid == 0)
    {
      ++process;
      continue;
    }
    if (pid < 0 && errno == EINTR)
      continue;
    if (pid < 0)
      throw IOError(std::string("waiting for a process: ") +
                    std::strerror(errno));
    const Ended ended{process->second.number, WIFEXITED(status)
                                                  ? WEXITSTATUS(status)
                                                  : -WTERMSIG(status)};
    process = running.erase(process);
    report(ended);
  }
}
} // namespace

bool run_processes(const std::size_t n, const unsigned int n_processes,
                   const Prepare &prepare,
                   const std::function<void(const Ended &)> &report)
{
  const SignalsHeld signals;
  bool is_stopping = stop_signal() != 0;
  std::chrono::steady_clock::time_point next_kill;
  Running running;
  std::deque<std::size_t> waiting;
  for (std::size_t i = 0; i < n; ++i)
    waiting.push_back(i);
  while (true)
  {
    report_ended(running, report);
    if (!is_stopping)
      start_some(waiting, running, n_processes, prepare, signals);
    if (running.empty() && (is_stopping || waiting.empty()))
      return !is_stopping;
    is_stopping = signals.wait() || is_stopping;
    const auto now = std::chrono::steady_clock::now();
    if (!is_stopping || now < next_kill)
      continue;
    next_kill = now + std::chrono::seconds(2);
    for (const auto &[pid, process] : running)
      kill(pid, process.stop_signal);
  }
}

std::string own_program()
{
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

bool is_on_path(const std::string &program)
{
  const char *const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0)
      return true;
  return false;
}
} // namespace sabot
