#ifndef sabot_bodies_spg_smooth_reference_h
#define sabot_bodies_spg_smooth_reference_h

#include "sabot/bodies/spg/spg_parts.h"

#include <mpi.h>

#include <optional>

namespace sabot
{
/**
 * Sawtooth of the places x of owned particles, which least-squares functions do
 * not see: an update at X = x would freeze it into them. Between updates the
 * pressure then pushes by the sawtooth of the last one, late by up to half a
 * period, and so drives it. Taken away where the pressure is more than a few
 * hundredths of the bulk modulus.
 *
 *   s = 0,  s_i += -1/2 sum_j w (y_j - y_i - F (X_j - X_i)) / sum_j w,
 *
 * y = x - s, F and X since the last update, four times over. Before the bonds
 * change; positions of ghosts up to date. Collective. @return s [m]; nothing
 * where no particle of any rank is pressed so hard, and of convex functions,
 * which see it.
 */
std::optional<AlignedVector<Vec>> find_sawtooth(const SpgParts &body,
                                                MPI_Comm communicator);

/**
 * F_inc of owned particles after an update at places X that are not x, by its
 * functions: what they see of x - X. The total F, the volume and the kernel of
 * now, F_inc H, stay. Least squares only. Collective, for kernels of ghosts.
 */
void settle_gradients(SpgParts &body);
} // namespace sabot

#endif
