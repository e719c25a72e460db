#ifndef sabot_simulation_run_quality_h
#define sabot_simulation_run_quality_h

#include "sabot/output/log.h"
#include "sabot/simulation/control_shares.h"
#include "sabot/simulation/scene.h"

namespace sabot
{
/**
 * PhysicsError where a contact of rigid bodies only has let them into each
 * other by more than a spacing, with what they closed in by per step: they may
 * pass through each other. Collective, the same on all ranks.
 */
void check_rigid_penetration(const Scene &scene);

/**
 * A warning to the log where the energy residual of a run, less than its
 * limit, is beyond what steps that are stable leave: 0.5 %.
 */
void describe_residual(const double residual, const RunSettings &settings,
                       Log &log);

/**
 * To the log, at the end of a run, how far its answer is to be trusted: shares
 * of hourglass control and stabilization of each body, penetration of each
 * contact; warnings where they are large. @p energy_scale: most energy that
 * passed through [J]. Collective.
 */
void describe_quality(const Scene &scene, const ControlShares &shares,
                      const double energy_scale, Log &log);
} // namespace sabot

#endif
