#ifndef sabot_output_rank_group_h
#define sabot_output_rank_group_h

#include <mpi.h>

namespace sabot
{
/**
 * The ranks whose state goes into one file: @p most of them, neighbors by their
 * numbers; the last group may be smaller. The first of each group writes.
 */
class RankGroup
{
public:
  /** The group of this rank. Collective over @p all. */
  RankGroup(MPI_Comm all, const int most) : most(most)
  {
    int rank_of_all, n_of_all;
    MPI_Comm_rank(all, &rank_of_all);
    MPI_Comm_size(all, &n_of_all);
    number = rank_of_all / most;
    n_groups = (n_of_all + most - 1) / most;
    MPI_Comm_split(all, number, rank_of_all, &communicator);
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);
  }
  ~RankGroup()
  {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (!is_over)
      MPI_Comm_free(&communicator);
  }
  RankGroup(const RankGroup &) = delete;

  /** Number among all ranks of the first of group @p g. */
  int first_of(const int g) const { return g * most; }
  int first() const { return first_of(number); }
  bool writes() const { return rank == 0; }

  MPI_Comm communicator; // of the group
  int number, n_groups;
  int rank, n_ranks; // within the group

private:
  const int most;
};
} // namespace sabot

#endif
