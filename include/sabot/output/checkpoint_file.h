#ifndef sabot_output_checkpoint_file_h
#define sabot_output_checkpoint_file_h

#include "sabot/output/hdf5_tools.h"
#include "sabot/output/state_blocks.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** What a checkpoint says of itself. */
struct CheckpointHeader
{
  std::string version;    // of the program that wrote it
  std::string parameters; // the expanded scene, to be compared with the present
  int n_ranks = 0;        // that wrote it; a run goes on with any number
  unsigned int step = 0;  // the last one that was done
  double time = 0.;       // after that step [s]
};

/**
 * The form of checkpoints, in the HDF5 part, all as bytes:
 *
 *     header      format, version, number of ranks, step, time (hexadecimal)
 *     parameters  the expanded scene, as in parameters.prm
 *     index       a line per array: rank, share, entries, size of one,
 *                 SHA-256, name
 *     parts       a line per further file: its first rank, number of ranks, the
 *                 digest behind its HDF5 part
 *     sha256      of header, index, parts and parameters together
 *     rank R/N    the N-th array of rank R, as it lay in memory; of what all
 *                 ranks have alike only that of rank 0
 *
 * A group of ranks has a file; further files have the same form, without parts
 * of their own.
 *
 * and after it, "\nSHA-256 " and the digest of all bytes before, which is
 * looked at first: HDF5 may do anything with a damaged file.
 *
 * Each array has a StateShare, by which it is dealt out among the ranks that go
 * on. Bits are stored as they are: a resumed run gives the results of a
 * straight one, on a machine of the same byte order.
 */
namespace checkpoint_format
{
/** Grows when older programs could not read what is written. */
constexpr unsigned int number = 5;
std::string dataset_name(const int rank, const std::size_t block);
/** Whether a line has a dataset of its own. */
inline bool is_stored(const int rank, const StateLine &line)
{
  return rank == 0 || line.share != static_cast<char>(StateShare::same);
}
/** Of the header, and of one line of the index. */
std::string text_of(const CheckpointHeader &header);
std::string text_of(const int rank, const StateLine &line);
/** Rank and line of such a text. */
std::pair<int, StateLine> line_of(const std::string &text);
/** Append the digest to the HDF5 part in @p file, which will be called @p name.
    @return it. IOError. */
std::string append_trailer(const std::string &file, const std::string &name);

/** A further file of a checkpoint. */
struct Part
{
  int first = 0, n = 0; // of its ranks
  std::string hash;     // digest behind its HDF5 part
};
/** Of the ranks from @p first on: "step-1.h5" has "step-1.rank-16.h5". */
std::string part_name(const std::string &file, const int first);
std::string text_of(const Part &part);
std::vector<Part> parts_of(const std::string &text);
} // namespace checkpoint_format

/**
 * A checkpoint to be read, one array at a time. IOError where it is cut short,
 * damaged, or of another format. Not collective: several ranks may read one
 * file.
 */
class CheckpointFile : public StateSource
{
public:
  /** Reads header and index, of further files too. */
  explicit CheckpointFile(const std::string &file);
  const CheckpointHeader &header() const { return its_header; }
  int n_ranks() const override { return index.size(); }
  const std::vector<StateLine> &lines(const int rank) const override
  {
    return index[rank];
  }
  std::vector<char> read(const int rank,
                         const std::size_t number) const override;
  /** Compare every byte of a checkpoint with its checksums; each rank looks at
      its share of the files. IOError, on rank 0 with what is wrong, on the
      others where they see it or without words. Collective. */
  static CheckpointHeader verify(const std::string &file,
                                 MPI_Comm communicator = MPI_COMM_SELF);

private:
  struct OneFile;
  /** Opens @p file, whose ranks are from @p first on. @return its parts. */
  std::string add_file(const std::string &file, const int first);
  const OneFile &file_of(const int rank) const;
  /** All arrays of the ranks of file number @p f, to see that they are whole.
   */
  void read_all(const std::size_t f) const;

  CheckpointHeader its_header;
  std::vector<std::shared_ptr<OneFile>> files; // by their first ranks
  std::vector<std::vector<StateLine>> index;   // of each rank
};
} // namespace sabot

#endif
