#ifndef sabot_simulation_plan_facts_h
#define sabot_simulation_plan_facts_h

#include "sabot/simulation/plan.h"

namespace sabot
{
/**
 * Facts of all bodies; before they are distributed.
 * Bounds are those of all nodes or particles, in the reference configuration
 * [m]; yield stresses are found with the law itself, see PlannedBody. Not
 * collective.
 */
std::vector<PlannedBody> find_body_facts(const Scene &scene);

/**
 * The pair with the largest relative speed, the faster body first.
 * Without any relative speed `exists` is false and the rest is of no meaning.
 * With U = v/2, k = rho U^2/Y of the projectile's density and the least yield
 * stress of all bodies, e = (sqrt(k^2 + 4 k) - k)/2.
 */
ImpactFacts find_impact(const std::vector<PlannedBody> &bodies);
} // namespace sabot

#endif
