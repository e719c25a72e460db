#include "sabot/simulation/plan_facts.h"
#include "sabot/base/parameters.h"

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
double find_yield_stress(const Material &material)
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
  constexpr int n_steps = 5000; // to a shear strain of one half
  for (int step = 0; step < n_steps; ++step)
  {
    factor = 1.;
    material.update(point);
    if (factor < 1.)
      return std::sqrt(3.) * std::abs(stress[3]);
  }
  return never;
}

/** The value of an entry of the present subsection, or @p standard where this
    kind of section has none. */
std::string get_or(Parameters &prm, const std::string &entry,
                   const std::string &standard)
{
  return prm.is_declared(entry) ? prm.get(entry) : standard;
}
} // namespace

std::vector<BodyFacts> find_body_facts(Scene &scene)
{
  Parameters &prm = scene.prm;
  std::vector<BodyFacts> facts;
  for (const auto &body : scene.bodies)
  {
    BodyFacts f;
    f.name = body->name;
    prm.enter_subsection("Bodies");
    prm.enter_subsection(body->name);
    f.material = prm.get("Material");
    f.is_spg = prm.get("Discretization") == "SPG";
    f.is_rigid = prm.get("Discretization") == "rigid";
    const std::vector<double> v = get_quantities(prm, "Initial velocity");
    f.velocity = {{v[0], v[1], v[2]}};
    f.failure_strain =
        f.is_spg ? get_quantity(prm, "Critical effective plastic strain")
                 : never;
    if (f.failure_strain >= 1e10)
      f.failure_strain = never;
    const std::vector<double> spacing =
        get_quantities(prm, f.is_spg ? "Nodal spacing" : "Cell size");
    f.spacing = *std::min_element(spacing.begin(), spacing.end());
    const bool is_from_file =
        !f.is_spg && get_or(prm, "Geometry", "") == "file";
    f.is_clamped = !get_or(prm, "Clamped faces", "").empty();
    prm.leave_subsection();
    prm.leave_subsection();
    prm.enter_subsection("Materials");
    prm.enter_subsection(f.material);
    const auto material = Material::make(prm, "Materials/" + f.material);
    const std::string eos = get_or(prm, "Equation of state", "");
    prm.leave_subsection();
    prm.leave_subsection();
    f.density = material->density();
    f.bulk_modulus = material->bulk_modulus();
    f.shear_modulus = material->shear_modulus();
    f.wave_speed = material->sound_speed();
    f.yield_stress = f.is_rigid ? never : find_yield_stress(*material);
    f.has_equation_of_state =
        !eos.empty() && eos.find("ulk modulus") == std::string::npos;
    f.low = {{never, never, never}};
    f.high = {{-never, -never, -never}};
    for (const auto &x : body->partition_points())
      for (int d = 0; d < 3; ++d)
      {
        f.low[d] = std::min(f.low[d], x[d]);
        f.high[d] = std::max(f.high[d], x[d]);
      }
    // Nobody told it: the edge of as many cubes that fill the same box.
    if (is_from_file)
      f.spacing = std::cbrt((f.high[0] - f.low[0]) * (f.high[1] - f.low[1]) *
                            (f.high[2] - f.low[2]) / body->n_items());
    facts.push_back(f);
  }
  return facts;
}

ImpactFacts find_impact(const std::vector<BodyFacts> &bodies)
{
  ImpactFacts impact;
  const auto relative = [&](const std::size_t a, const std::size_t b)
  {
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += std::pow(bodies[a].velocity[d] - bodies[b].velocity[d], 2);
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
          own += std::pow(bodies[a].velocity[d], 2);
          other += std::pow(bodies[b].velocity[d], 2);
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
  const BodyFacts &p = bodies[impact.projectile], &t = bodies[impact.target];
  double largest = -1.;
  for (int d = 0; d < 3; ++d)
    if (std::abs(p.velocity[d] - t.velocity[d]) > largest)
    {
      largest = std::abs(p.velocity[d] - t.velocity[d]);
      impact.axis = d;
    }
  impact.radius = never;
  for (int d = 0; d < 3; ++d)
    if (d != impact.axis)
      impact.radius = std::min(impact.radius, 0.5 * (p.high[d] - p.low[d]));
  const double half = 0.5 * impact.speed;
  double yield = never;
  for (const BodyFacts &body : bodies)
    yield = std::min(yield, body.yield_stress);
  if (yield < never)
  {
    const double k = p.density * half * half / yield;
    const double e = 0.5 * (std::sqrt(k * k + 4. * k) - k);
    impact.largest_strain = std::min(std::log(4.), -std::log1p(-e));
  }
  impact.strain_rate = half / impact.radius;
  return impact;
}
} // namespace sabot
