// What a run will cost: a few steps are timed and scaled to the whole.

#include "sabot/base/error.h"
#include "sabot/integrator/stepper.h"
#include "sabot/output/checkpoint.h"
#include "sabot/simulation/plan_output.h"
#include "sabot/simulation/run.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sabot
{
namespace
{
using Clock = std::chrono::steady_clock;

double since(const Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double sum_over_ranks(double value, MPI_Comm communicator)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return value;
}

/** Mean time of a step in the median of up to nine stretches of equally many
    steps: what else the machine did in one of them does not count, kernel
    updates and searches do. [s] */
double typical_seconds(const std::vector<double> &seconds)
{
  constexpr std::size_t least_stretch = 60; // two kernel updates, as a rule
  const std::size_t n =
      std::clamp<std::size_t>(seconds.size() / least_stretch, 1, 9);
  std::vector<double> means;
  for (std::size_t k = 0; k < n; ++k)
  {
    const std::size_t begin = seconds.size() * k / n,
                      end = seconds.size() * (k + 1) / n;
    double sum = 0.;
    for (std::size_t s = begin; s < end; ++s)
      sum += seconds[s];
    means.push_back(sum / (end - begin));
  }
  std::nth_element(means.begin(), means.begin() + n / 2, means.end());
  return means[n / 2];
}

/** Integral over the rest of the run of the step now over the step then [s]. */
double steps_left(const ImpactFacts &impact, const double now, const double end)
{
  if (!impact.exists)
    return std::max(0., end - now);
  const auto strain = [&](const double t)
  { return std::min(impact.largest_strain, impact.strain_rate * t); };
  constexpr int n = 1000;
  double sum = 0.;
  for (int i = 0; i < n; ++i)
    sum += std::exp(strain(now + (end - now) * (i + 0.5) / n) - strain(now));
  return std::max(0., end - now) * sum / n;
}
} // namespace

CostPlan plan_cost(Scene &scene, const PhysicsPlan &physics,
                   const double seconds, MPI_Comm communicator)
{
  const auto start = Clock::now();
  CostPlan plan;
  Timers timers;
  Stepper stepper(scene.bodies, scene.loads, scene.couplings,
                  step_limits(scene.settings), timers, communicator);
  scene.distribute();
  stepper.initialize();
  plan.set_up_seconds = since(start);
  for (const auto &body : scene.bodies)
  {
    CostPlan::Item item{body->name, body->item_name(), double(body->n_items()),
                        0.};
    if (const ParticleView *const particles = body->particles())
      item.neighbors =
          sum_over_ranks(particles->n_bonds(), communicator) / item.n;
    plan.items.push_back(item);
  }
  const OutputEstimate output(scene, physics, communicator);
  {
    StateSaver saver;
    for (const auto &body : scene.bodies)
      body->visit_state(saver);
    for (const auto &load : scene.loads)
      load->visit_state(saver);
    double bytes = 0.;
    for (const StateBlock &saved : saver.blocks)
      bytes += saved.bytes.size();
    plan.checkpoint_bytes = sum_over_ranks(bytes, communicator);
  }

  constexpr unsigned int least_steps = 6;
  std::vector<double> steps, step_seconds;
  const auto calibration = Clock::now();
  for (bool go_on = true; go_on;)
  {
    const auto step_start = Clock::now();
    const StepProposal proposal = stepper.propose(false);
    if (steps.empty())
    {
      plan.first_stable_step = proposal.dt;
      plan.accuracy = scene.settings.accuracy;
      plan.limiter = proposal.limiter;
    }
    steps.push_back(stepper.choose(proposal));
    try
    {
      stepper.advance(steps.back(), stepper.substeps(proposal, steps.back()));
      stepper.update();
    }
    catch (const PhysicsError &e)
    {
      plan.problem = e.what();
      step_seconds.push_back(since(step_start));
      break;
    }
    step_seconds.push_back(since(step_start));
    int more = !stepper.is_finished() &&
               (steps.size() < least_steps || since(calibration) < seconds);
    MPI_Bcast(&more, 1, MPI_INT, 0, communicator);
    go_on = more != 0;
  }
  plan.seconds_per_step = typical_seconds(step_seconds);
  plan.calibration_steps = steps.size();
  double sum = 0.;
  const std::size_t half = steps.size() / 2;
  for (std::size_t s = half; s < steps.size(); ++s)
    sum += steps[s];
  plan.mean_step = sum / (steps.size() - half);
  plan.steps = steps.size() + steps_left(physics.impact, stepper.time(),
                                         scene.settings.end_time) /
                                  plan.mean_step;
  plan.steps = std::ceil(plan.steps * (1. - 1e-9));
  plan.output_bytes =
      output.bytes(stepper.time(), plan.steps) +
      (scene.settings.checkpoint_at_end ? plan.checkpoint_bytes : 0.);
  plan.seconds = plan.set_up_seconds + plan.steps * plan.seconds_per_step +
                 output_seconds(scene, plan.steps, communicator);
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  plan.memory_bytes = sum_over_ranks(1024. * usage.ru_maxrss, communicator);
  return plan;
}
} // namespace sabot
