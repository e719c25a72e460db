#ifndef sabot_output_vtu_writer_h
#define sabot_output_vtu_writer_h

#include "sabot/base/measures.h"

#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Fields for ParaView by VTK: per body and time one compressed .vtu of doubles
 * with shared nodes and true cell data (and a .pvtu over the ranks' pieces), in
 * fields/; sabot.pvd lists all bodies at all times as one scene. All files are
 * written new, then renamed. Symmetric tensors have components XX, YY, ZZ, XY,
 * YZ, XZ. All functions are collective and throw IOError on all ranks.
 */
class VtuWriter
{
public:
  VtuWriter(const std::string &folder, MPI_Comm communicator);

  void write_body(const std::string &body, const OutputMesh &mesh,
                  const unsigned int frame);
  /** Add a written frame to sabot.pvd. @p time in s. */
  void add_time(const double time, const unsigned int frame,
                const std::vector<std::string> &bodies);

  /** Times and frames of sabot.pvd; a resumed run takes them over. */
  std::vector<std::pair<double, unsigned int>> frames;

private:
  std::string piece_name(const std::string &body, const unsigned int frame,
                         const int rank) const;
  void agree(const std::string &problem) const;
  void write_collection(const std::string &body, const OutputMesh &mesh,
                        const unsigned int frame) const;

  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
};
} // namespace sabot

#endif
