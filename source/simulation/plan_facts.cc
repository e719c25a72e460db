// What the plan knows of the bodies and of their impact before the run.
#include "sabot/simulation/plan_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
constexpr double never = std::numeric_limits<double>::max();

/** Von Mises stress at which a law first flows in pure shear at about
    1e3 1/s. */
std::optional<double> find_yield_stress(const Material &material)
{
  std::vector<double> states;
  for (const StateVariable &variable : material.state_variables())
    states.insert(states.end(), variable.is_tensor ? 6 : 1,
                  variable.initial_value);
  std::vector<double *> pointers;
  for (double &state : states)
    pointers.push_back(&state);
  double strain[6] = {0., 0., 0., 1e-4, 0., 0.}, stress[6] = {};
  double jacobian = 1., extra = 0., factor = 1., work = 0.;
  double gradient[9] = {1., 0., 0., 0., 1., 0., 0., 0., 1.};
  MaterialBatch point;
  point.n = 1;
  point.dt = 1e-7;
  for (int c = 0; c < 6; ++c)
  {
    point.strain_increment[c] = &strain[c];
    point.stress[c] = &stress[c];
  }
  point.jacobian = &jacobian;
  point.states = pointers.data();
  point.extra_square = &extra;
  point.return_factor = &factor;
  point.plastic_work = &work;
  point.viscous_pressure = &extra;
  for (int c = 0; c < 9; ++c)
    point.deformation_gradient[c] = &gradient[c];
  constexpr int n_steps = 5000; // to a shear strain of one half
  for (int step = 0; step < n_steps; ++step)
  {
    factor = 1.;
    gradient[1] += 2. * strain[3];
    material.update(point);
    if (factor < 1.)
      return std::sqrt(3.) * std::abs(stress[3]);
  }
  return std::nullopt;
}

} // namespace

std::vector<PlannedBody> find_body_facts(const Scene &scene)
{
  std::vector<PlannedBody> bodies;
  for (const auto &body : scene.bodies)
  {
    PlannedBody b{body->name, body->facts(), std::nullopt, {}, {}};
    if (b.facts.deforms)
      b.yield_stress = find_yield_stress(*b.facts.material);
    b.low = {{never, never, never}};
    b.high = {{-never, -never, -never}};
    for (const auto &x : body->partition_points())
      for (int d = 0; d < 3; ++d)
      {
        b.low[d] = std::min(b.low[d], x[d]);
        b.high[d] = std::max(b.high[d], x[d]);
      }
    for (const SymmetryPlane &plane : body->planes_of_symmetry())
      b.is_cut[plane.axis] = true;
    bodies.push_back(b);
  }
  for (const GrowingZone &zone : scene.growing) // without points of its own
  {
    bodies[zone.zone].low = bodies[zone.host].low;
    bodies[zone.zone].high = bodies[zone.host].high;
  }
  return bodies;
}

ImpactFacts find_impact(const std::vector<PlannedBody> &bodies)
{
  ImpactFacts impact;
  const auto relative = [&](const std::size_t a, const std::size_t b)
  {
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += std::pow(
          bodies[a].facts.velocity[d] - bodies[b].facts.velocity[d], 2);
    return std::sqrt(square);
  };
  const auto size = [&](const std::size_t b)
  {
    double volume = 1.;
    for (int d = 0; d < 3; ++d)
      volume *= bodies[b].high[d] - bodies[b].low[d];
    return volume;
  };
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
      const double speed = relative(a, b);
      if (speed > impact.speed * (1. + 1e-12) ||
          (speed > 0. && speed > impact.speed * (1. - 1e-12) &&
           a == impact.projectile && size(b) > size(impact.target)))
      {
        double own = 0., other = 0.;
        for (int d = 0; d < 3; ++d)
        {
          own += std::pow(bodies[a].facts.velocity[d], 2);
          other += std::pow(bodies[b].facts.velocity[d], 2);
        }
        if (own < other)
          continue; // the faster one is the projectile
        impact.exists = true;
        impact.speed = speed;
        impact.projectile = a;
        impact.target = b;
      }
    }
  if (!impact.exists)
    return impact;
  const PlannedBody &p = bodies[impact.projectile], &t = bodies[impact.target];
  double largest = -1.;
  for (int d = 0; d < 3; ++d)
    if (std::abs(p.facts.velocity[d] - t.facts.velocity[d]) > largest)
    {
      largest = std::abs(p.facts.velocity[d] - t.facts.velocity[d]);
      impact.axis = d;
    }
  impact.radius = never;
  for (int d = 0; d < 3; ++d)
    if (d != impact.axis)
      impact.radius = std::min(impact.radius, (p.is_cut[d] ? 1. : 0.5) *
                                                  (p.high[d] - p.low[d]));
  const double half = 0.5 * impact.speed;
  double yield = never;
  for (const PlannedBody &body : bodies)
    yield = std::min(yield, body.yield_stress.value_or(never));
  if (yield < never)
  {
    const double k = p.facts.material->density() * half * half / yield;
    const double e = 0.5 * (std::sqrt(k * k + 4. * k) - k);
    impact.largest_strain = std::min(std::log(4.), -std::log1p(-e));
  }
  impact.strain_rate = half / impact.radius;
  return impact;
}
} // namespace sabot
