#ifndef sabot_output_checkpoint_h
#define sabot_output_checkpoint_h

#include "sabot/output/checkpoint_file.h"
#include "sabot/output/kept_folder.h"

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Checkpoints of a run as HDF5: step-<number>.h5 in a folder of their own, each
 * with the arrays of all ranks and an index that holds the length and the
 * SHA-256 of every array; the SHA-256 of the file follows its HDF5 part
 * (CheckpointFile). Files are written new, flushed to the disk and renamed; the
 * last two are kept, as the newest may be what a failing disk left.
 *
 * Rank 0 writes for all, in pieces of some megabytes as the other ranks send
 * them one after the other, from where the arrays are: no rank needs memory for
 * a copy of its state or for that of others.
 */
class CheckpointFolder
{
public:
  /** Shows the state, once on each rank. */
  using Visit = std::function<void(StateVisitor &)>;

  /** @p folder is made when it does not exist. IOError. Collective. */
  CheckpointFolder(const std::string &folder, MPI_Comm communicator);

  /** Remove the checkpoints of an earlier run; what cannot be removed stays.
      Collective, though rank 0 works alone. */
  void clear();
  /** @p name: empty for the next of the series, otherwise the name of a file
      that resume does not take. @return the file's size in bytes. IOError on
      all ranks when any failed. Collective. */
  std::size_t write(const CheckpointHeader &header, const Visit &visit,
                    const std::string &name = "") const;

  /** What is wrong with the folder now; empty: nothing, or not rank 0. */
  std::string trouble() const { return kept ? kept->trouble() : ""; }

  /** Files of the series, newest first; none where there is no folder. Not
      collective. */
  static std::vector<std::string> list(const std::string &folder);

private:
  /** IOError on all ranks where rank 0 has a @p problem. Collective. */
  void throw_together(const std::string &problem) const;
  /** The work of rank 0. @p begin: called once the file is there; others send
      from then on. @return its size in bytes. */
  std::size_t write_file(const CheckpointHeader &header, const Visit &visit,
                         const std::string &name,
                         const std::function<void()> &begin) const;
  /** Its own arrays, and those of others as they come; lines of all to the
      @p index. @return whether there was no trouble. */
  bool write_arrays(const hid_t h5, const Visit &visit,
                    std::string &index) const;

  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
  std::unique_ptr<KeptFolder> kept; // rank 0
};
} // namespace sabot

#endif
