// What a step costs now, and once the cells that are expected to have turned
// into particles.
#include "sabot/simulation/plan_growth.h"

#include "sabot/base/error.h"
#include "sabot/couplings/self_finding_zone.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
using Clock = std::chrono::steady_clock;

double since(const Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/** Makes and times a step; whether it went well. Collective. */
bool make_step(Stepper &stepper, TimedSteps &timed)
{
  const auto start = Clock::now();
  const StepProposal proposal = stepper.propose(false);
  timed.steps.push_back(stepper.choose(proposal));
  try
  {
    stepper.advance(timed.steps.back(),
                    stepper.substeps(proposal, timed.steps.back()));
    stepper.update();
  }
  catch (const PhysicsError &e)
  {
    timed.problem = e.what();
  }
  timed.seconds.push_back(since(start));
  return timed.problem.empty();
}

/** Particles that are expected by then, of split cells as many as their
   lattices have. Collective. */
double count_turned(const Scene &scene, const GrowingZone &zone,
                    const ConversionForecast &forecast, const double time,
                    const std::vector<double> &at_node, MPI_Comm communicator)
{
  const NodalState &nodes = scene.bodies[zone.host]->nodes();
  double n = 0.;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const Vec X = nodes.reference_position[i];
    if (forecast.has_turned({{X[0], X[1], X[2]}}, time))
      n += at_node.empty() ? 1. : at_node[nodes.global_id[i]];
  }
  MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return n;
}

/** What the steps of the run so far rest on, and how they go on. */
class StepForecast
{
public:
  StepForecast(const Scene &scene, const PhysicsPlan &physics,
               const std::vector<ConversionForecast> &forecasts,
               const Stepper &stepper, const double couplings, const double now)
      : stepper(stepper), forecasts(forecasts), impact(physics.impact),
        couplings(at_contact(forecasts, couplings, now)), now(now),
        own(stepper.propose(false).body_steps), most(scene.bodies.size(), 0.)
  {
    if (!impact.exists)
      return;
    for (const std::size_t b : {impact.projectile, impact.target})
      if (physics.bodies[b].yield_stress)
        most[b] = impact.largest_strain;
    for (std::size_t z = 0; z < forecasts.size(); ++z)
      if (forecasts[z].exists())
        for (const int b : {scene.growing[z].host, scene.growing[z].zone})
          most[b] = std::min(most[b], forecasts[z].largest_strain);
  }

  double step(const double time) const
  {
    std::vector<double> then = own;
    for (std::size_t b = 0; b < own.size(); ++b)
      then[b] *= std::exp(std::min(most[b], impact.strain_rate * now) -
                          std::min(most[b], impact.strain_rate * time));
    double slower = 1.;
    for (const ConversionForecast &forecast : forecasts)
      slower = std::min(slower,
                        forecast.speed_left(time) / forecast.speed_left(now));
    return std::min(
        stepper.limits.largest,
        stepper.limits.factor *
            stepper.step_of(then, couplings / std::max(slower, 1e-3)));
  }

private:
  /** What couplings ask for once the bodies have met: closing in allows half of
      the time until then on top (ClosingLimit). */
  static double at_contact(const std::vector<ConversionForecast> &forecasts,
                           const double couplings, const double now)
  {
    double first = std::numeric_limits<double>::max();
    for (const ConversionForecast &forecast : forecasts)
      if (forecast.exists())
        first = std::min(first, forecast.first_time());
    const double then = couplings - 0.5 * (first - now);
    return first > now && then > 0. ? then : couplings;
  }

  const Stepper &stepper;
  const std::vector<ConversionForecast> &forecasts;
  const ImpactFacts &impact;
  const double couplings, now; // [s]: what couplings ask for, at what time
  const std::vector<double> own;
  std::vector<double> most; // strain that flattens the cells of a body
};

/** Of a scene whose cells have turned. [s] of wall time */
struct GrownPrice
{
  double step, bite; // bite: on top of a step
};

GrownPrice time_grown(Scene &scene,
                      const std::vector<ConversionForecast> &forecasts,
                      const double half, Stepper &stepper, const double seconds,
                      MPI_Comm communicator)
{
  const double end = scene.settings.end_time;
  TimedSteps bites;
  for (const double time : {half, end})
  {
    for (std::size_t z = 0; z < forecasts.size(); ++z)
      scene.growing[z].coupling->turn_next(
          [&, z, time](const std::array<double, 3> &place)
          { return forecasts[z].has_turned(place, time); });
    // What contact has to search anew comes in the next step.
    bites = TimedSteps();
    if (!make_step(stepper, bites) || !make_step(stepper, bites))
      return {0., 0.};
  }
  const TimedSteps timed = make_steps(stepper, seconds, communicator);
  const double step = timed.typical_seconds();
  return {step, std::max(0., bites.seconds[0] + bites.seconds[1] - 2. * step)};
}
} // namespace

double TimedSteps::typical_seconds() const
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

double TimedSteps::mean_of_second_half() const
{
  double sum = 0.;
  const std::size_t half = steps.size() / 2;
  for (std::size_t s = half; s < steps.size(); ++s)
    sum += steps[s];
  return sum / (steps.size() - half);
}

TimedSteps make_steps(Stepper &stepper, const double seconds,
                      MPI_Comm communicator)
{
  constexpr unsigned int least_steps = 6;
  TimedSteps timed;
  const auto start = Clock::now();
  for (int more = 1; more != 0;)
  {
    more = make_step(stepper, timed) && !stepper.is_finished() &&
           (timed.steps.size() < least_steps || since(start) < seconds);
    MPI_Bcast(&more, 1, MPI_INT, 0, communicator);
  }
  return timed;
}

void add_growth(Scene &scene, const PhysicsPlan &physics,
                const std::vector<ConversionForecast> &forecasts,
                Stepper &stepper, const double seconds, MPI_Comm communicator,
                CostPlan &plan)
{
  constexpr int n_parts = 50;
  const double now = stepper.time(), end = scene.settings.end_time,
               part = (end - now) / n_parts;
  std::vector<double> n_turned(n_parts + 1, 0.); // particles
  for (std::size_t z = 0; z < forecasts.size(); ++z)
  {
    const GrowingZone &zone = scene.growing[z];
    CostPlan::Conversion found{scene.bodies[zone.zone]->name,
                               scene.bodies[zone.host]->name,
                               forecasts[z].basis,
                               0.,
                               0.,
                               0.};
    if (forecasts[z].exists())
    {
      const auto &lattices =
          scene.bodies[zone.zone]->particle_sink()->lattices();
      const std::vector<double> at_node =
          lattices ? lattices->sites_by_node() : std::vector<double>();
      for (int k = 0; k <= n_parts; ++k)
      {
        found.n_particles = count_turned(scene, zone, forecasts[z],
                                         now + k * part, at_node, communicator);
        n_turned[k] += found.n_particles;
      }
      found.first = forecasts[z].first_time();
      found.last = forecasts[z].last_time();
    }
    plan.conversions.push_back(found);
  }
  const double all = std::max(1., n_turned.back());
  const double couplings = stepper.propose(false).coupling_step;
  GrownPrice grown{plan.seconds_per_step, 0.};
  if (n_turned.back() > 0. && !stepper.is_finished() && plan.problem.empty())
  {
    int k = 0;
    while (k < n_parts && n_turned[k] < 0.5 * all)
      ++k;
    const GrownPrice price =
        time_grown(scene, forecasts, now + std::max(0, k - 1) * part, stepper,
                   seconds, communicator);
    if (price.step > 0.)
      grown = price;
  }
  const StepForecast steps(scene, physics, forecasts, stepper, couplings, now);
  double n_steps = plan.calibration_steps,
         time = n_steps * plan.seconds_per_step, more = 0.;
  unsigned int interval = 1;
  for (const GrowingZone &zone : scene.growing)
    interval = std::max(interval, zone.request.interval);
  for (int k = 0; k < n_parts; ++k)
  {
    const double n = part / steps.step(now + (k + 0.5) * part),
                 share = 0.5 * (n_turned[k] + n_turned[k + 1]) / all;
    n_steps += n;
    time += n * plan.seconds_per_step;
    // Looks that find something; each brings all that there is up to date.
    const double looks = std::min(n / interval, n_turned[k + 1] - n_turned[k]);
    more +=
        share * (n * (grown.step - plan.seconds_per_step) + looks * grown.bite);
  }
  plan.steps = std::ceil(n_steps * (1. - 1e-9));
  plan.conversion_seconds = more;
  plan.seconds += time + more;
  plan.seconds_per_step = (time + more) / plan.steps;
}
} // namespace sabot
