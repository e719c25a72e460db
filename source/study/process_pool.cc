// Runs programs, several at a time.
#include "sabot/study/process_pool.h"

#include "sabot/base/error.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

extern char **environ;

namespace sabot
{
namespace
{
volatile std::sig_atomic_t asked_to_stop = 0;
void note_signal(int)
{
  asked_to_stop = 1;
}

/** Without SA_RESTART, so that waiting ends when a signal comes. */
class SignalsNoted
{
public:
  SignalsNoted()
  {
    struct sigaction action = {};
    action.sa_handler = note_signal;
    sigaction(SIGINT, &action, &old_interrupt);
    sigaction(SIGTERM, &action, &old_terminate);
  }
  ~SignalsNoted()
  {
    sigaction(SIGINT, &old_interrupt, nullptr);
    sigaction(SIGTERM, &old_terminate, nullptr);
  }

private:
  struct sigaction old_interrupt, old_terminate;
};

pid_t start(const Command &command)
{
  std::vector<char *> words;
  for (const std::string &word : command.words)
    words.push_back(const_cast<char *>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null",
                                   O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, command.log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // A group of its own: a Ctrl-C at the terminal reaches it through us, once.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, words[0], &actions, &attributes,
                                 words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw IOError("cannot start \"" + command.words[0] +
                  "\": " + std::strerror(error));
  return pid;
}
} // namespace

bool run_processes(const std::vector<Command> &commands,
                   const unsigned int n_processes,
                   const std::function<void(const Ended &)> &report)
{
  const SignalsNoted noted;
  asked_to_stop = 0;
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  bool passed_on = false;
  while (!running.empty() || (next < commands.size() && !asked_to_stop))
  {
    while (!asked_to_stop && next < commands.size() &&
           running.size() < n_processes)
    {
      running[start(commands[next])] = next;
      ++next;
    }
    if (asked_to_stop && !passed_on)
    {
      for (const auto &process : running)
        kill(process.first, SIGTERM);
      passed_on = true;
    }
    int status = 0;
    const pid_t pid = waitpid(-1, &status, 0);
    if (pid < 0)
    {
      if (errno == EINTR)
        continue;
      throw IOError(std::string("waiting for a process: ") +
                    std::strerror(errno));
    }
    const auto process = running.find(pid);
    if (process == running.end())
      continue;
    const Ended ended{process->second, WIFEXITED(status) ? WEXITSTATUS(status)
                                                         : -WTERMSIG(status)};
    running.erase(process);
    report(ended);
  }
  return next == commands.size() && !asked_to_stop;
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
