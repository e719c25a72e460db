// Starts and ends MPI through deal.II.
#include "sabot/base/mpi_session.h"

#include "sabot/base/stop_signals.h"

#include <deal.II/base/mpi.h>

namespace sabot
{
struct MpiSession::Libraries
{
  dealii::Utilities::MPI::MPI_InitFinalize all;
};

MpiSession::MpiSession(int &argc, char **&argv)
{
  const StopSignalsWait wait;
  libraries.reset(new Libraries{{argc, argv, 1}});
}

MpiSession::~MpiSession() = default;

int MpiSession::rank() const
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int MpiSession::n_ranks() const
{
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  return n_ranks;
}
} // namespace sabot
