// Files are the affair of one rank, their trouble that of all.
#include "sabot/output/first_rank.h"

#include "sabot/base/error.h"

#include <string>

namespace sabot
{
void on_first_rank(MPI_Comm communicator, const char *const what,
                   const std::function<void()> &work)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::string problem;
  if (rank == 0)
    try
    {
      work();
    }
    catch (const IOError &e)
    {
      problem = e.what();
    }
  int is_bad = !problem.empty();
  MPI_Bcast(&is_bad, 1, MPI_INT, 0, communicator);
  if (is_bad)
    throw IOError(problem.empty() ? "rank 0 could not " + std::string(what)
                                  : problem);
}
} // namespace sabot
