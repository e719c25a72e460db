// Errors become a line and an exit code; memory that does not suffice has a
// name.
#include "sabot/base/error_report.h"

#include "sabot/base/text.h"

#include <deal.II/base/exceptions.h>

#include <mpi.h>

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>
#include <stdexcept>

namespace sabot
{
namespace
{
/** Gigabytes that the kernel says in a line "NAME:   12 kB" of @p file; 0 where
    it does not. */
double gigabytes(const char *const file, const std::string &name)
{
  for (const std::string &line : lines_of(file))
    if (line.compare(0, name.size() + 1, name + ":") == 0)
      return 1024e-9 * std::strtod(&line[name.size() + 1], nullptr);
  return 0.;
}

/** What the process has, and what there is. */
std::string memory_in_words()
{
  rlimit limit = {};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    return formatted("the process has taken %.3g GB of address space",
                     gigabytes("/proc/self/status", "VmSize")) +
           formatted(" and may have %.3g GB (ulimit -v)",
                     1e-9 * limit.rlim_cur);
  return formatted("the process has %.3g GB",
                   gigabytes("/proc/self/status", "VmRSS")) +
         formatted(", and of the machine's %.3g GB",
                   gigabytes("/proc/meminfo", "MemTotal")) +
         formatted(" %.3g GB are free",
                   gigabytes("/proc/meminfo", "MemAvailable"));
}

MemoryError memory_error(const std::string &what)
{
  return MemoryError("memory does not suffice for " + what + ": " +
                     memory_in_words() +
                     "; \"sabot plan\" says what a scene needs");
}

/** What one rank met alone. */
int end_all(const bool uses_mpi, const std::string &message,
            const ExitCode code)
{
  int rank = 0, n_ranks = 1;
  if (uses_mpi)
  {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  }
  std::cerr << "error: " +
                   (n_ranks > 1 ? "rank " + std::to_string(rank) + ": " : "") +
                   message + "\n"
            << std::flush;
  if (n_ranks > 1)
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  return static_cast<int>(code);
}

int all_say(const bool uses_mpi, const char *const message, const ExitCode code)
{
  int rank = 0;
  if (uses_mpi)
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    std::cerr << "error: " << message << std::endl;
  return static_cast<int>(code);
}
} // namespace

int report_errors(const bool uses_mpi, const std::function<ExitCode()> &work)
{
  try
  {
    ExitCode code = ExitCode::done;
    within_memory("this command", [&]() { code = work(); });
    return static_cast<int>(code);
  }
  catch (const InputError &e)
  {
    return all_say(uses_mpi, e.what(), ExitCode::bad_input);
  }
  catch (const IOError &e)
  {
    return all_say(uses_mpi, e.what(), ExitCode::io_failed);
  }
  catch (const StoppedEarly &e)
  {
    return all_say(uses_mpi, e.what(), ExitCode::interrupted);
  }
  catch (const MemoryError &e)
  {
    return end_all(uses_mpi, e.what(), ExitCode::no_memory);
  }
  catch (const std::filesystem::filesystem_error &e)
  {
    return end_all(uses_mpi, in_one_line(e.what()), ExitCode::io_failed);
  }
  catch (const std::exception &e)
  {
    return end_all(uses_mpi, in_one_line(e.what()), ExitCode::program_fault);
  }
}

std::string in_one_line(const std::string &what)
{
  const std::string start = "Additional information:";
  const std::size_t at = what.find(start);
  std::string text =
      at == std::string::npos ? what : what.substr(at + start.size());
  text = text.substr(0, text.find("Stacktrace:"));
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;)
    if (word.find_first_not_of('-') != std::string::npos)
      line += (line.empty() ? "" : " ") + word;
  return line.empty() ? "an error without a message" : line;
}

void within_memory(const std::string &what, const std::function<void()> &work)
{
  try
  {
    work();
  }
  catch (const std::bad_alloc &)
  {
    throw memory_error(what);
  }
  catch (const std::length_error &) // more than any address space holds
  {
    throw memory_error(what);
  }
  catch (const dealii::StandardExceptions::ExcOutOfMemory &)
  {
    throw memory_error(what);
  }
}
} // namespace sabot
