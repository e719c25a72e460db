#ifndef sabot_output_run_files_h
#define sabot_output_run_files_h

#include "sabot/base/state_visitor.h"
#include "sabot/output/history.h"
#include "sabot/output/kept_folder.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
class Body;
class VtuWriter;

/**
 * The folder of a run and the files in it that its outputs share: fields of
 * all bodies (fields/ and sabot.pvd) and histories (history.h5). Two outputs
 * of one kind thus add to one file, and no time is written twice.
 *
 * The run makes it, fills the histories and hands it to its outputs:
 *
 *     for (const auto &output : outputs)
 *       output->open(files);
 *     ...                                  // after each step
 *     for (const auto &output : outputs)
 *       output->write_when_due({time, step, is_last, bodies}, files);
 *
 * An output of another kind needs the folder and the communicator only.
 */
class RunFiles
{
public:
  /** @p folder must exist when the first file is written. Not collective. */
  RunFiles(const std::string &folder, MPI_Comm communicator);
  ~RunFiles();

  const std::string folder;
  const MPI_Comm communicator;

  /** Make the folder where it is missing and see to it that it stays, see
      KeptFolder. IOError. Rank 0 only. */
  void keep_folder();
  /** What is wrong with the folder now; empty: nothing, or not kept. */
  std::string folder_trouble() const;

  /** Tables that the run fills, the same on every rank; in memory until
      write_history(). */
  History history;

  /** Make ready to write fields; may be called again. IOError on all ranks
      where the folder cannot be made. Collective. */
  void open_fields();
  /** Fields of @p bodies on their deformed configurations at @p time [s] as
      the next frame; nothing where the last frame is of this time.
      @return whether it wrote. IOError on all ranks. Collective. */
  bool write_fields(const double time, const std::vector<const Body *> &bodies);
  /** Write history.h5 by rank 0, whole, where it has new rows. IOError on all
      ranks. Collective. */
  void write_history();

  /** Rows, times and numbers of frames: what a resumed run goes on from. */
  void visit_state(StateVisitor &visitor);

private:
  /** Rows of all tables together. */
  std::size_t n_rows() const;
  /** The tables: names, columns, numbers. */
  void visit_history(StateVisitor &visitor);

  std::unique_ptr<KeptFolder> kept; // rank 0
  std::unique_ptr<VtuWriter> fields;
  unsigned int frame = 0;    // number of the next one
  std::size_t n_written = 0; // rows of all tables in history.h5
};
} // namespace sabot

#endif
