#ifndef sabot_base_send_some_h
#define sabot_base_send_some_h

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sabot
{
/** Each rank tells each other what concerns it: @p to_rank [number of ranks],
    entries go as they are in memory. @return what all ranks told this one,
   itself included, in the order of the ranks. Entries that nobody is told cost
   nothing; up to 2^31 entries of a rank, std::length_error beyond. Collective.
 */
template <typename T>
std::vector<T> send_some(const std::vector<std::vector<T>> &to_rank,
                         MPI_Comm communicator)
{
  const std::size_t n_ranks = to_rank.size();
  if (n_ranks == 1)
    return to_rank[0];
  const auto places = [](const std::vector<int> &counts)
  {
    std::vector<int> starts = {0};
    for (const int n : counts)
    {
      if (n > std::numeric_limits<int>::max() - starts.back())
        throw std::length_error("more entries for a rank than MPI can count");
      starts.push_back(starts.back() + n);
    }
    return starts;
  };
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<int> n_out, n_in(n_ranks);
  for (const std::vector<T> &its : to_rank)
    n_out.push_back(its.size());
  MPI_Alltoall(n_out.data(), 1, MPI_INT, n_in.data(), 1, MPI_INT, communicator);
  const std::vector<int> start_in = places(n_in);
  std::vector<T> out, in(start_in.back());
  // Its own part goes straight to its place.
  std::copy(to_rank[rank].begin(), to_rank[rank].end(),
            in.begin() + start_in[rank]);
  n_out[rank] = n_in[rank] = 0;
  const std::vector<int> start_out = places(n_out);
  out.reserve(start_out.back());
  for (std::size_t r = 0; r < n_ranks; ++r)
    if (int(r) != rank)
      out.insert(out.end(), to_rank[r].begin(), to_rank[r].end());
  MPI_Datatype entry;
  MPI_Type_contiguous(sizeof(T), MPI_BYTE, &entry);
  MPI_Type_commit(&entry);
  MPI_Alltoallv(out.data(), n_out.data(), start_out.data(), entry, in.data(),
                n_in.data(), start_in.data(), entry, communicator);
  MPI_Type_free(&entry);
  return in;
}
} // namespace sabot

#endif
