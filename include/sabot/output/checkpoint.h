#ifndef sabot_output_checkpoint_h
#define sabot_output_checkpoint_h

#include "sabot/output/checkpoint_arrays.h"
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
 * with the arrays of the first ranks and an index that holds the length and the
 * SHA-256 of every array; the SHA-256 of the file follows its HDF5 part
 * (CheckpointFile). More ranks than a file takes have further files, which the
 * first one names with their digests. Files are written new, flushed to the
 * disk and renamed, the first one last; the last two checkpoints are kept, as
 * the newest may be what a failing disk left.
 *
 * The first rank of each group writes for it (checkpoint_arrays), all groups at
 * the same time.
 */
class CheckpointFolder
{
public:
  using Visit = checkpoint_arrays::Visit;

  /** @p folder is made when it does not exist. @p ranks_per_file: > 0. IOError.
      Collective. */
  CheckpointFolder(const std::string &folder, MPI_Comm communicator,
                   const int ranks_per_file = 16);

  /** Remove the checkpoints of an earlier run; what cannot be removed stays.
      Collective, though rank 0 works alone. */
  void clear();
  /** @p name: empty for the next of the series, otherwise the name of a file
      that resume does not take. @return on rank 0 the size of all files in
      bytes. IOError on all ranks when any failed. Collective. */
  std::size_t write(const CheckpointHeader &header, const Visit &visit,
                    const std::string &name = "") const;

  /** What is wrong with the folder now; empty: nothing, or not rank 0. */
  std::string trouble() const { return kept ? kept->trouble() : ""; }

  /** First files of the series, newest first; none where there is no folder.
      Not collective. */
  static std::vector<std::string> list(const std::string &folder);

private:
  struct FileEnd; // of what a rank wrote
  /** IOError on all ranks where rank 0 has a @p problem. Collective. */
  void throw_together(const std::string &problem) const;
  /** Of all ranks, on rank 0. Collective. */
  std::vector<FileEnd> gather(const FileEnd &own) const;
  /** The work of rank 0. @p begin: called once the file is there; others send
      from then on. @return the size of all files in bytes. */
  std::size_t write_first_file(const CheckpointHeader &header,
                               const Visit &visit, const std::string &file,
                               const std::function<void()> &begin) const;
  /** The work of the first rank of a further group. Never throws. */
  FileEnd write_part(const CheckpointHeader &header, const Visit &visit,
                     const std::vector<StateLine> &of_first,
                     const std::string &file) const;
  /** The work of all ranks but 0. */
  void write_other(const CheckpointHeader &header, const Visit &visit,
                   const std::string &file) const;
  /** All but the last two, and further files that are left without their
      first one. */
  void remove_old() const;

  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
  const RankGroup group;            // whose state goes into one file
  std::unique_ptr<KeptFolder> kept; // rank 0
};
} // namespace sabot

#endif
