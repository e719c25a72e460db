#ifndef sabot_simulation_plan_growth_h
#define sabot_simulation_plan_growth_h

#include "sabot/integrator/stepper.h"
#include "sabot/simulation/plan.h"
#include "sabot/simulation/plan_conversion.h"

#include <mpi.h>

#include <string>
#include <vector>

namespace sabot
{
/** Steps that were made to see what one costs. */
struct TimedSteps
{
  std::vector<double> steps, seconds; // [s] of the scene, of wall time
  std::string problem;                // what ended them, if anything did

  /** Mean time of a step in the median of up to nine stretches of equally many
      steps: what else the machine did in one of them does not count, kernel
      updates and searches do. [s] */
  double typical_seconds() const;
  double mean_of_second_half() const; // [s] of the scene
};

/** For about @p seconds of wall time, at least six unless the run ends or a
    PhysicsError comes up, which is told. Collective. */
TimedSteps make_steps(Stepper &stepper, const double seconds,
                      MPI_Comm communicator);

/**
 * Steps and time of a scene in which cells turn into particles. What the
 * @p forecasts foresee at the end is turned now, in two bites; what a step
 * costs then, and what a bite does, is timed for @p seconds. In between both
 * go by the share of the particles that there are.
 *
 * A step is the least of what couplings ask for, which closing in does by the
 * speed left, and of the bodies' own, those of the two that meet shrunk by
 * exp(-strain): min(largest_strain, t strain_rate) of ImpactFacts for a body
 * that yields, no more than the onset strain where its cells turn.
 *
 * Sets steps, adds to seconds of the plan, and lists what was foreseen.
 * Collective; the scene is used up.
 */
void add_growth(Scene &scene, const PhysicsPlan &physics,
                const std::vector<ConversionForecast> &forecasts,
                Stepper &stepper, const double seconds, MPI_Comm communicator,
                CostPlan &plan);
} // namespace sabot

#endif
