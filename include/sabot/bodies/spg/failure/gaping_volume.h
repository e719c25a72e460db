#ifndef sabot_bodies_spg_failure_gaping_volume_h
#define sabot_bodies_spg_failure_gaping_volume_h

#include <cstddef>

namespace sabot
{
struct SpgParts;

/** Whether owned particle @p i is failed metal without any stress, under a rule
    that leaves no tension: pieces apart from each other. Local. */
bool gapes(const SpgParts &body, const std::size_t i);

/**
 * At an update of all kernels, after they have followed: the volume of metal
 * that gapes is at most as many times that of the start as a kernel holds
 * spacings cubed,
 *
 *   V_ref <= 4 pi/3 s^3 V_0,   s the normalized support,
 *
 * what a particle has for itself that is alone in its kernel. V is a product of
 * J_inc over all updates, each by neighbors of its own, and where nothing bears
 * it nothing holds it: it would drift to any size, and the work of a step,
 * which goes by V/V_0, would be more than an equation of state can follow.
 * F_ref loses the same, equally in all directions. No energy: there is no
 * stress. Owned particles; local.
 */
void bound_gaping_volumes(SpgParts &body);
} // namespace sabot

#endif
