// What a run says, on the screen and in log.txt.
#include "sabot/output/log.h"

#include "sabot/base/error.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

namespace sabot
{
Log::Log(const bool quiet, MPI_Comm communicator)
    : quiet(quiet), terminal(isatty(STDOUT_FILENO) == 1)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  speaks = rank == 0;
}

void Log::open(const std::string &name, const bool append)
{
  if (!speaks)
    return;
  errno = 0;
  file.open(name, append ? std::ios::app : std::ios::trunc);
  if (!file)
    throw IOError("cannot write \"" + name + "\": " + std::strerror(errno));
}

void Log::line(const std::string &text)
{
  if (!speaks)
    return;
  if (!quiet)
  {
    if (open_line)
      std::cout << "\n";
    open_line = false;
    std::cout << text << std::endl;
  }
  if (file.is_open())
    file << text << std::endl;
}

void Log::warning(const std::string &text)
{
  line("warning: " + text);
}

void Log::record(const std::string &text)
{
  if (!speaks)
    return;
  if (!quiet && !terminal)
    std::cout << text << std::endl;
  if (file.is_open())
    file << text << std::endl;
}

bool Log::wants_progress() const
{
  return speaks && !quiet && terminal &&
         std::chrono::steady_clock::now() - last_progress >
             std::chrono::milliseconds(200);
}

void Log::progress(const std::string &text)
{
  if (!wants_progress())
    return;
  last_progress = std::chrono::steady_clock::now();
  std::cout << "\r\033[K" << text << std::flush;
  open_line = true;
}
} // namespace sabot
