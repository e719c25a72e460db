#ifndef sabot_base_gather_all_h
#define sabot_base_gather_all_h

#include <mpi.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sabot
{
/** Concatenate the vectors of all ranks in rank order; entries go as they are
   in memory. Up to 2^31 entries of all ranks, whatever their size;
   std::length_error on all ranks where there are more. Collective, the same on
   all ranks. */
template <typename Vector>
Vector gather_all(const Vector &mine, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1)
    return mine;
  const std::int64_t n_mine = mine.size();
  std::vector<std::int64_t> sizes(n_ranks);
  MPI_Allgather(&n_mine, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T,
                communicator);
  std::int64_t n = 0;
  std::vector<int> counts, starts;
  for (const std::int64_t size : sizes)
  {
    starts.push_back(n);
    counts.push_back(size);
    n += size;
    if (n > std::numeric_limits<int>::max())
      throw std::length_error("more entries of all ranks than MPI can count");
  }
  // Counted in entries, for bytes are soon more than an int holds.
  MPI_Datatype entry;
  MPI_Type_contiguous(sizeof(mine[0]), MPI_BYTE, &entry);
  MPI_Type_commit(&entry);
  Vector all(n);
  MPI_Allgatherv(mine.data(), n_mine, entry, all.data(), counts.data(),
                 starts.data(), entry, communicator);
  MPI_Type_free(&entry);
  return all;
}
} // namespace sabot

#endif
