#ifndef sabot_output_item_fields_h
#define sabot_output_item_fields_h

#include "sabot/base/measures.h"

#include <mpi.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
// Fields of a body as values of its cells or particles, whatever they are
// written on. Local to a rank.

/** Present place of each item of this rank's part [m]: the mean of its nodes.
 */
std::vector<std::array<double, 3>> item_positions(const OutputMesh &mesh);

/** The field @p name of each item: that of cells and particles, or of nodes the
    mean over those of the item. Nothing where the body has no such field. */
std::optional<OutputField> item_field(const OutputMesh &mesh,
                                      const std::string &name);

/** "x" to "z" or "xx" to "xz" for component @p c of @p n; nothing for one. */
std::string component_name(const unsigned int n, const unsigned int c);

/** Which rank gives the least of these rows of numbers, compared one by one as
    words are; rows of all ranks are of one length. A rank that has none gives
    an empty row. -1: none has any. The row becomes that of the winner.
    Collective. */
int least_row(std::vector<double> &row, const std::size_t length,
              MPI_Comm communicator);
} // namespace sabot

#endif
