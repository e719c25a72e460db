#ifndef sabot_output_checkpoint_h
#define sabot_output_checkpoint_h

#include "sabot/output/state_blocks.h"

#include <mpi.h>

#include <string>
#include <vector>

namespace sabot
{
/** What a checkpoint says of itself. */
struct CheckpointHeader
{
  std::string version;    // of the program
  std::string parameters; // the expanded scene
  int n_ranks = 0;
  unsigned int step = 0;
  double time = 0.; // [s]
};

/**
 * Checkpoints of a run as HDF5: step-<number>.h5 in a folder of their own, each
 * with the arrays of all ranks and an index that holds the length and the
 * SHA-256 of every array; the SHA-256 of the file follows its HDF5 part. Files
 * are written new, flushed to the disk and renamed; the last two are kept.
 */
class CheckpointFolder
{
public:
  /** @p folder is made when it does not exist. IOError. Collective. */
  CheckpointFolder(const std::string &folder, MPI_Comm communicator);

  /** Remove the checkpoints of an earlier run. Collective. */
  void clear();
  /** @p name: empty for the next of the series, otherwise the name of a file
      that resume does not take. @return the file's size in bytes. IOError on
      all ranks when any failed. Collective. */
  std::size_t write(const CheckpointHeader &header,
                    const std::vector<StateBlock> &blocks,
                    const std::string &name = "") const;

  /** Files of the series, newest first. */
  static std::vector<std::string> list(const std::string &folder);
  /** Read the header and check the whole file. IOError says what is wrong. */
  static CheckpointHeader verify(const std::string &file);
  /** Blocks of one rank of a verified file. IOError. */
  static std::vector<StateBlock> read(const std::string &file, const int rank);

  static constexpr unsigned int format = 1;

private:
  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
};
} // namespace sabot

#endif
