#ifndef sabot_base_text_of_ranks_h
#define sabot_base_text_of_ranks_h

#include <mpi.h>

#include <string>

namespace sabot
{
/** The @p text of rank @p root to all ranks. Collective. */
inline void broadcast_text(std::string &text, MPI_Comm communicator,
                           const int root = 0)
{
  unsigned long length = text.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, root, communicator);
  text.resize(length);
  MPI_Bcast(&text[0], length, MPI_CHAR, root, communicator);
}

/** The text of the first rank that has one, on all ranks; empty where none has:
    what went wrong, of which one tells the others. Collective. */
inline std::string text_of_first(std::string text, MPI_Comm communicator)
{
  int rank, n_ranks;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  int first = text.empty() ? n_ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, communicator);
  if (first == n_ranks)
    return "";
  broadcast_text(text, communicator, first);
  return text;
}
} // namespace sabot

#endif
