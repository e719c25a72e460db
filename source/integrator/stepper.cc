// Chooses and makes the steps of a scene.
#include "sabot/integrator/stepper.h"

#include <algorithm>
#include <cmath>

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

std::vector<unsigned int> Stepper::substeps(const StepProposal &proposal,
                                            const double step) const
{
  std::vector<unsigned int> counts(proposal.body_steps.size(), 1);
  for (std::size_t b = 0; b < counts.size(); ++b)
    if (const Substeps::Member *const member = integrator.substeps.of(b))
      counts[b] = member->next(step / (limits.factor * proposal.body_steps[b]));
  return counts;
}

double Stepper::mean_substeps(const Body &body) const
{
  const Substeps::Member *const member = integrator.substeps.of(body.id);
  return member == nullptr || n_steps == 0 ? 1.
                                           : double(member->made) / n_steps;
}

void Stepper::advance(const double step,
                      const std::vector<unsigned int> &counts)
{
  if (is_cut(step))
    integrator.keep_stiffness(dt);
  dt = step;
  integrator.advance(step, counts);
  ++n_steps;
}

void Stepper::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("time", integrator.time);
  visitor.visit_value("step", n_steps);
  visitor.visit_value("step size", dt);
}

void Stepper::visit_substeps(StateVisitor &visitor)
{
  integrator.substeps.visit_state(visitor);
}
} // namespace sabot
