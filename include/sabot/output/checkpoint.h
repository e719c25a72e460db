#ifndef sabot_output_checkpoint_h
#define sabot_output_checkpoint_h

#include "sabot/output/kept_folder.h"
#include "sabot/output/state_blocks.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** What a checkpoint says of itself. */
struct CheckpointHeader
{
  std::string version;    // of the program that wrote it
  std::string parameters; // the expanded scene, to be compared with the present
  int n_ranks = 0;        // a run goes on with as many
  unsigned int step = 0;  // the last one that was done
  double time = 0.;       // after that step [s]
};

/**
 * Checkpoints of a run as HDF5: step-<number>.h5 in a folder of their own, each
 * with the arrays of all ranks and an index that holds the length and the
 * SHA-256 of every array; the SHA-256 of the file follows its HDF5 part. Files
 * are written new, flushed to the disk and renamed; the last two are kept, as
 * the newest may be what a failing disk left.
 *
 * In the HDF5 part, all as bytes:
 *
 *     header      format, version, number of ranks, step, time (hexadecimal)
 *     parameters  the expanded scene, as in parameters.prm
 *     index       a line per array: rank, entries, size of one, SHA-256, name
 *     sha256      of header, index and parameters together
 *     rank R/N    the N-th array of rank R, as it lay in memory
 *
 * and after it, "\nSHA-256 " and the digest of all bytes before, which is
 * looked at first: HDF5 may do anything with a damaged file.
 *
 * Rank 0 writes for all, one array at a time, so that no rank needs memory for
 * the state of the others. Bits are stored as they are: a resumed run gives the
 * results of a straight one, on a machine of the same byte order.
 */
class CheckpointFolder
{
public:
  /** @p folder is made when it does not exist. IOError. Collective. */
  CheckpointFolder(const std::string &folder, MPI_Comm communicator);

  /** Remove the checkpoints of an earlier run; what cannot be removed stays.
      Collective, though rank 0 works alone. */
  void clear();
  /** @p name: empty for the next of the series, otherwise the name of a file
      that resume does not take. @return the file's size in bytes. IOError on
      all ranks when any failed. Collective. */
  std::size_t write(const CheckpointHeader &header,
                    const std::vector<StateBlock> &blocks,
                    const std::string &name = "") const;

  /** What is wrong with the folder now; empty: nothing, or not rank 0. */
  std::string trouble() const { return kept ? kept->trouble() : ""; }

  /** Files of the series, newest first; none where there is no folder. Not
      collective, as the next two. */
  static std::vector<std::string> list(const std::string &folder);
  /** Read the header and check the whole file against its checksums. IOError
      says what is wrong: cut short, damaged, another format. */
  static CheckpointHeader verify(const std::string &file);
  /** Blocks of one rank of a verified file, in the order in which they were
      saved. IOError. */
  static std::vector<StateBlock> read(const std::string &file, const int rank);

  /** Grows when older programs could not read what is written. */
  static constexpr unsigned int format = 1;

private:
  /** IOError on all ranks where rank 0 has a @p problem. Collective. */
  void throw_together(const std::string &problem) const;

  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
  std::unique_ptr<KeptFolder> kept; // rank 0
};
} // namespace sabot

#endif
