// What a run will cost: a few steps are timed and scaled to the whole.

#include "sabot/integrator/stepper.h"
#include "sabot/output/checkpoint.h"
#include "sabot/simulation/plan_growth.h"
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

void list_items(const Scene &scene, CostPlan &plan, MPI_Comm communicator)
{
  for (const auto &body : scene.bodies)
  {
    CostPlan::Item item{body->name, body->item_name(), double(body->n_items()),
                        0.};
    if (const ParticleView *const particles = body->particles())
      item.neighbors =
          sum_over_ranks(particles->n_bonds(), communicator) / item.n;
    plan.items.push_back(item);
  }
}

double checkpoint_size(const Scene &scene, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  double bytes = 0.;
  StateSaver saver(
      [&](const StateLine &line, const void *)
      {
        if (rank == 0 || line.share != static_cast<char>(StateShare::same))
          bytes += line.n_bytes();
      });
  for (const auto &body : scene.bodies)
    body->visit_state(saver);
  for (const auto &load : scene.loads)
    load->visit_state(saver);
  return sum_over_ranks(bytes, communicator);
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
  const auto forecasts = foresee_conversions(scene, physics);
  scene.distribute();
  stepper.initialize();
  plan.set_up_seconds = since(start);
  list_items(scene, plan, communicator);
  const OutputEstimate output(scene, physics, communicator);
  plan.checkpoint_bytes = checkpoint_size(scene, communicator);
  {
    const StepProposal first = stepper.propose(false);
    plan.first_stable_step = first.dt;
    plan.accuracy = scene.settings.accuracy;
    plan.limiter = first.limiter;
  }
  const TimedSteps timed = make_steps(stepper, seconds, communicator);
  plan.problem = timed.problem;
  plan.seconds_per_step = timed.typical_seconds();
  plan.calibration_steps = timed.steps.size();
  plan.mean_step = timed.mean_of_second_half();
  const double n_made = timed.steps.size();
  plan.steps = n_made + steps_left(physics.impact, stepper.time(),
                                   scene.settings.end_time) /
                            plan.mean_step;
  plan.steps = std::ceil(plan.steps * (1. - 1e-9));
  plan.output_bytes =
      output.bytes(stepper.time(), plan.steps) +
      (scene.settings.checkpoint_at_end ? plan.checkpoint_bytes : 0.);
  plan.seconds =
      plan.set_up_seconds + output_seconds(scene, plan.steps, communicator);
  if (scene.growing.empty())
    plan.seconds += plan.steps * plan.seconds_per_step;
  else
    add_growth(scene, physics, forecasts, stepper, seconds, communicator, plan);
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  plan.memory_bytes = sum_over_ranks(1024. * usage.ru_maxrss, communicator);
  return plan;
}
} // namespace sabot
