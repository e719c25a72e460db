// Chooses and makes the steps of a scene.
#include "sabot/integrator/stepper.h"

#include <algorithm>

namespace sabot
{
double Stepper::choose(const StepProposal &proposal) const
{
  double next = std::min(limits.factor * proposal.dt, limits.largest);
  if (n_steps > 0)
    next = std::min(next, limits.growth * dt);
  const double left = limits.end_time - time();
  return left <= next * (1. + 1e-9) ? left : next;
}

void Stepper::advance(const double step)
{
  dt = step;
  integrator.advance(step);
  ++n_steps;
}

void Stepper::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("time", integrator.time);
  visitor.visit_value("step", n_steps);
  visitor.visit_value("step size", dt);
}
} // namespace sabot
