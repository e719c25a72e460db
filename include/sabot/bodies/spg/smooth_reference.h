#ifndef sabot_bodies_spg_smooth_reference_h
#define sabot_bodies_spg_smooth_reference_h

#include "sabot/bodies/spg/spg_parts.h"

#include <mpi.h>

#include <optional>

namespace sabot
{
/** Sawtooth of the motion since the last kernel update, of owned particles. */
std::optional<AlignedVector<Vec>> find_sawtooth(const SpgParts &body, MPI_Comm communicator);
/** F_inc of positions that differ from those of the update. */
void settle_gradients(SpgParts &body);
} // namespace sabot

#endif
