#ifndef sabot_output_checkpoint_arrays_h
#define sabot_output_checkpoint_arrays_h

#include "sabot/output/checkpoint_file.h"
#include "sabot/output/rank_group.h"

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

namespace sabot
{
/**
 * How the arrays of a group of ranks come into the file that the first of them
 * writes: in pieces of some megabytes as the others send them one after the
 * other, from where the arrays are. No rank needs memory for a copy of its
 * state or for that of others.
 */
namespace checkpoint_arrays
{
/** Shows the state, once on each rank. */
using Visit = std::function<void(StateVisitor &)>;

/** Bytes as a dataset of their own. @return whether there was no trouble. */
bool write_bytes(const hid_t file, const std::string &name, const void *data,
                 const std::size_t n_bytes);

/** Of rank 0: write its arrays, add their lines to @p index and @p lines.
    @return whether there was no trouble. */
bool write_first(const hid_t h5, const Visit &visit,
                 std::vector<StateLine> &lines, std::string &index);
/** Of rank @p rank > 0 that writes a file: the same. What it has as rank 0 has
    it, by @p of_first, is not stored. Never throws. */
bool write_own(const hid_t h5, const Visit &visit,
               const std::vector<StateLine> &of_first, const int rank,
               std::string &index);
/** Write the arrays of the other ranks of a @p group as they arrive, and add
    their lines to @p index. @return whether there was no trouble; all are heard
    to the end even then. */
bool receive_others(const hid_t h5, const RankGroup &group, std::string &index);
/** Of rank @p rank, which writes no file: to the first of its @p group. Never
    throws. */
void send_own(const Visit &visit, const std::vector<StateLine> &of_first,
              const int rank, const RankGroup &group);

/** Rank 0's @p lines to all. Collective. */
void tell_lines(std::vector<StateLine> &lines, MPI_Comm communicator);
} // namespace checkpoint_arrays
} // namespace sabot

#endif
