#ifndef sabot_simulation_plan_facts_h
#define sabot_simulation_plan_facts_h

#include "sabot/simulation/plan.h"

namespace sabot
{
/** Facts of all bodies; before they are distributed. */
std::vector<PlannedBody> find_body_facts(const Scene &scene);

/** The pair with the largest relative speed, the faster body first. */
ImpactFacts find_impact(const std::vector<PlannedBody> &bodies);
} // namespace sabot

#endif
