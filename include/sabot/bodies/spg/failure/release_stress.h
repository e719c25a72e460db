#ifndef sabot_bodies_spg_failure_release_stress_h
#define sabot_bodies_spg_failure_release_stress_h

#include <cstddef>

namespace sabot
{
struct SpgParts;

/**
 * Take away the stress that owned particle @p i cannot bear any more because it
 * lost a direction just now, between two steps, by the body's rule for failed
 * metal. The elastic energy that goes with it,
 *
 *   V [ p^2/(2 K) + s : s/(4 G) ]  before less after,
 *
 * p the mean and s the deviator of the stress, V the present volume, is counted
 * as lost [J]. Local to the rank.
 *
 * Called at the end of an update of kernels or of cracks, when it is known
 * which directions are gone.
 *
 * K and G are those at rest. Stress in the present frame, changed in place; the
 * loss is added to BondFailure::loss.
 */
void release_stress(SpgParts &body, const std::size_t i);
} // namespace sabot

#endif
