#ifndef sabot_output_vtu_writer_h
#define sabot_output_vtu_writer_h

#include "sabot/base/measures.h"
#include "sabot/output/kept_folder.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Fields for ParaView by VTK (XML formats): per body and time one compressed
 * .vtu of doubles with shared nodes and true cell data (and a .pvtu over the
 * ranks' pieces), in fields/; sabot.pvd lists all bodies at all times as one
 * scene. All files are written new, then renamed. Symmetric tensors have
 * components XX, YY, ZZ, XY, YZ, XZ; points are in current positions [m],
 * fields in SI units, which every array carries as VTK's UNITS_LABEL. Particles
 * are vertices: what cells have as cell data they have as such, too, so that a
 * field has one name and one association throughout the scene, and once more
 * as point data for glyphs.
 *
 *     sabot.pvd                    which bodies at which times
 *     fields/plate_000012.vtu      body "plate", frame 12, one rank
 *     fields/plate_000012.pvtu     the same of several ranks, joined from
 *     fields/plate_000012_0.vtu    what rank 0 owns, and so on
 *
 * All functions are collective and throw IOError on all ranks when one could
 * not write. A body's name becomes part of file names, blanks, slashes and
 * quotes as hyphens.
 */
class VtuWriter
{
public:
  /** Makes FOLDER/fields. */
  VtuWriter(const std::string &folder, MPI_Comm communicator);

  /** Write this rank's piece of a body as frame number @p frame; all ranks
      have the same fields. Does not show in sabot.pvd before add_time(). */
  void write_body(const std::string &body, const OutputMesh &mesh,
                  const unsigned int frame);
  /** Add a written frame to sabot.pvd. @p time in s. */
  void add_time(const double time, const unsigned int frame,
                const std::vector<std::string> &bodies);

  /** Times and frames of sabot.pvd; a resumed run takes them over. */
  std::vector<std::pair<double, unsigned int>> frames;

private:
  /** Name of a rank's .vtu, without folder. */
  std::string piece_name(const std::string &body, const unsigned int frame,
                         const int rank) const;
  /** IOError on all ranks when @p problem is not empty on one. */
  void agree(const std::string &problem) const;
  /** The .pvtu that joins the ranks' pieces; by rank 0. */
  void write_collection(const std::string &body, const OutputMesh &mesh,
                        const unsigned int frame) const;
  /** What another number of ranks has left of a frame, before the run went on
      from an earlier one. By rank 0. */
  void remove_other_pieces(const std::string &body,
                           const unsigned int frame) const;
  /** Below the folder: that of one rank, or what joins those of several,
      whichever wrote the frame. By rank 0. */
  std::string frame_file(const std::string &body,
                         const unsigned int frame) const;

  const std::string folder; // of the run
  MPI_Comm communicator;
  int rank, n_ranks;
  std::unique_ptr<KeptFolder> kept; // of the fields; rank 0
};
} // namespace sabot

#endif
