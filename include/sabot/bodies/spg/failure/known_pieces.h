#ifndef sabot_bodies_spg_failure_known_pieces_h
#define sabot_bodies_spg_failure_known_pieces_h

#include "sabot/base/memory_table.h"
#include "sabot/base/types.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/spg/spg_parts.h"

#include <mpi.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Which particles bonds hold together, and to which images, kept as long as
 * no bond has come or gone and no metal has crumbled: every row of the
 * histories asks several times, bonds change every few steps.
 *
 * By BondList::n_changes() and BondFailure::n_changes(), which are the same on
 * all ranks. Labels and planes are made when they are asked for, not before.
 */
class KnownPieces
{
public:
  /** As fragment_labels(); collective. */
  const std::vector<GlobalIndex> &labels(const SpgParts &body,
                                         MPI_Comm communicator);
  /** As planes_of_particles(), of the same @p planes at every call. */
  const std::vector<unsigned int> &
  planes(const SpgParts &body, const std::vector<SymmetryPlane> &planes,
         const double tolerance);

  void list_memory(MemoryTable &table) const
  {
    table.add("pieces: labels", label);
    table.add("pieces: planes", plane_bits);
  }

private:
  using Changes = std::pair<std::size_t, std::size_t>; // of bonds, of failure

  /** Whether what was made at @p made is of the present bonds, and note that it
      is from now on. */
  static bool is_present(Changes &made, const SpgParts &body);

  // Counts of changes begin with 1: these are of nothing.
  Changes labels_made = {0, 0}, planes_made = {0, 0};
  std::vector<GlobalIndex> label;       // owned
  std::vector<unsigned int> plane_bits; // owned
};
} // namespace sabot

#endif
