// Which physics a scene needs, from dimensionless numbers.
#include "sabot/simulation/accuracy.h"
#include "sabot/simulation/plan_facts.h"
#include "sabot/simulation/zone_verdict.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace sabot
{
namespace
{
constexpr double never = std::numeric_limits<double>::max();

std::string text(const char *const pattern, const double a, const double b = 0.)
{
  char buffer[300];
  std::snprintf(buffer, sizeof(buffer), pattern, a, b);
  return buffer;
}

/** Diffusivity of copper, the largest among structural metals [m^2/s]
    (k / (rho c_p) = 400 / (8960 * 385)). */
constexpr double largest_diffusivity = 1.2e-4;

void judge_heat(const Scene &scene, PhysicsPlan &plan)
{
  double spacing = never;
  for (const PlannedBody &body : plan.bodies)
    for (const double h : body.facts.spacing)
      spacing = std::min(spacing, h);
  const double fourier =
      largest_diffusivity * scene.settings.end_time / (spacing * spacing);
  plan.numbers.push_back(
      {"Fourier number", "alpha t / h^2, with alpha of copper", fourier,
       fourier < 0.1
           ? "heat stays where it arises: no conduction needed"
           : "heat may spread over a spacing within the run: conduction may "
             "matter, depending on the material"});
}

/** Bodies whose particles a plane shock of @p pressure [Pa] would shake. */
void judge_shocks(const double pressure, PhysicsPlan &plan)
{
  for (const PlannedBody &body : plan.bodies)
  {
    if (!body.facts.deforms || !body.facts.largest_shock)
      continue;
    const double most = *body.facts.largest_shock,
                 shock = pressure / body.facts.material->bulk_modulus();
    if (shock > most)
      plan.numbers.push_back(
          {"that pressure over the bulk modulus of " + body.name,
           "least-squares functions", shock,
           text("plane shocks above some %.3g shake such particles; ", most) +
               (shock < BodyFacts::wide_shock
                    ? "\"Normalized support size = 2.5\" bears them, as "
                      "\"Approximation = convex exponential\" does"
                    : "\"Approximation = convex exponential\" bears them")});
  }
}

void judge_impact(const Scene &scene, PhysicsPlan &plan)
{
  const ImpactFacts &impact = plan.impact;
  const PlannedBody &p = plan.bodies[impact.projectile],
                    &t = plan.bodies[impact.target];
  const Material &of_p = *p.facts.material, &of_t = *t.facts.material;
  const double Zp = of_p.density() * of_p.sound_speed(),
               Zt = of_t.density() * of_t.sound_speed();
  const bool p_is_rigid = !p.facts.deforms, t_is_rigid = !t.facts.deforms;
  // A rigid body is infinitely stiff, and no law of its own counts.
  if (p_is_rigid && t_is_rigid)
    return;
  const double pressure = impact.speed * (p_is_rigid   ? Zt
                                          : t_is_rigid ? Zp
                                                       : Zp * Zt / (Zp + Zt));
  const double K = p_is_rigid ? of_t.bulk_modulus()
                   : t_is_rigid
                       ? of_p.bulk_modulus()
                       : std::min(of_p.bulk_modulus(), of_t.bulk_modulus());
  plan.numbers.push_back(
      {"impact pressure over bulk modulus", "v Z1 Z2 / (Z1 + Z2) / K",
       pressure / K,
       pressure / K < 0.05 ? "a constant bulk modulus will do"
       : pressure / K < 0.3
           ? "an equation of state changes the first wave by " +
                 text("about %.0f %%; what follows less", 150. * pressure / K)
           : "an equation of state is needed"});
  judge_shocks(pressure, plan);
  if (pressure / K >= 0.3)
    for (const PlannedBody *const body : {&p, &t})
      if (body->facts.deforms && !body->facts.material->has_equation_of_state())
        plan.warnings.push_back("body \"" + body->name +
                                "\" is shocked beyond a linear law, but its "
                                "material \"" +
                                body->facts.material->name +
                                "\" has no equation of state");

  if (p.yield_stress || t.yield_stress)
  {
    const double dynamic = of_p.density() * impact.speed * impact.speed;
    const double damage = p.yield_stress ? dynamic / *p.yield_stress : 0.;
    if (p.yield_stress)
      plan.numbers.push_back({"dynamic pressure over the projectile's yield",
                              "rho v^2 / Y", damage,
                              damage < 0.1 ? "the projectile stays elastic: a "
                                             "rigid one would do"
                              : damage < 1.
                                  ? "the projectile yields a little"
                                  : "the projectile deforms much and must be "
                                    "deformable"});
    else
    {
      const double over = dynamic / *t.yield_stress;
      if (over > 10.)
        plan.warnings.push_back(
            "body \"" + p.name + "\" never yields, though rho v^2 is " +
            text("%.3g times the yield stress of what it hits; check that it "
                 "is so much stronger",
                 over));
    }
  }

  for (const double component : t.facts.velocity)
    if (component != 0.)
      return; // no target at rest with a far boundary and a rear face
  // How far a wave gets, along the plate.
  double far = 0.;
  for (int d = 0; d < 3; ++d)
    if (d != impact.axis)
      far = std::max(far, 0.5 * (t.high[d] - t.low[d]));
  const double trips =
      of_t.sound_speed() * scene.settings.end_time / (2. * far);
  plan.numbers.push_back(
      {"round trips of waves to the far boundary", "c t / (2 L)", trips,
       trips < 1. ? "the boundary is not felt: body \"" + t.name +
                        text("\" may shrink to %.3g m across",
                             2. * far * std::max(trips, 0.05))
                  : "the boundary is felt: its size and support matter"});

  const double thickness = t.high[impact.axis] - t.low[impact.axis];
  const double transits =
      impact.speed * scene.settings.end_time /
      (thickness + p.high[impact.axis] - p.low[impact.axis]);
  plan.numbers.push_back(
      {"transits", "v t / (thickness + length of the projectile)", transits,
       transits < 1.   ? "the run ends before the projectile could pass"
       : transits < 3. ? "the projectile is watched until it has passed"
                       : "the run goes on well beyond the passage"});
}

void judge_zones_before(const Scene &scene, PhysicsPlan &plan)
{
  for (const ZoneBox &zone : find_zones(scene))
  {
    const PlannedBody &body = plan.bodies[zone.zone];
    if (!plan.impact.exists || !body.facts.failure_strain)
      continue;
    double half = never, spacing = 0.;
    for (int d = 0; d < 3; ++d)
      if (d != plan.impact.axis && (zone.tied_low[d] || zone.tied_high[d]))
      {
        // Of a half or quarter the center is at the side that is not tied.
        const bool both = zone.tied_low[d] && zone.tied_high[d];
        half = std::min(half, (both ? 0.5 : 1.) * (zone.high[d] - zone.low[d]));
        spacing = std::max(spacing, zone.spacing[d]);
      }
    if (half == never)
      continue;
    // A hole opened from nothing in an incompressible sheet: a point at r came
    // from sqrt(r^2 - a^2), and its effective strain is 2/sqrt(3) ln(r/r0).
    const double a = plan.impact.radius;
    const auto radius = [&](const double strain)
    { return a / std::sqrt(1. - std::exp(-std::sqrt(3.) * strain)); };
    const double needed = radius(*body.facts.failure_strain) + 2. * spacing;
    plan.numbers.push_back(
        {"zone \"" + body.name + "\" over the region of failure",
         "half width / (a / sqrt(1 - exp(-sqrt(3) eps_f)) + 2 h)",
         half / needed,
         half >= needed
             ? text("wide enough to hold broken bonds; plastic flow over 1 %% "
                    "may reach %.3g m",
                    std::min(radius(0.01), 1e3))
             : text("too narrow: bonds may break at the tie; give it a half "
                    "width of %.3g m",
                    needed)});
    if (half < needed)
      plan.warnings.push_back("zone \"" + body.name +
                              "\" is narrower than the region where bonds are "
                              "expected to break");
  }
}

void judge_hourglass_control(PhysicsPlan &plan)
{
  for (const PlannedBody &body : plan.bodies)
    if (body.facts.hourglass_control == "viscous" && !body.yield_stress)
      plan.warnings.push_back(
          "body \"" + body.name +
          "\" never yields, but its hourglass control is viscous, which takes "
          "energy from what should spring back; use \"stiffness\" or "
          "\"B-bar\"");
}

void judge_symmetry(PhysicsPlan &plan)
{
  if (!plan.impact.exists)
    return;
  // Symmetry about the line of flight, by boxes and velocities.
  const PlannedBody &p = plan.bodies[plan.impact.projectile];
  std::string axes;
  for (int d = 0; d < 3; ++d)
  {
    if (d == plan.impact.axis)
      continue;
    const double center = 0.5 * (p.low[d] + p.high[d]);
    bool symmetric = true;
    for (const PlannedBody &body : plan.bodies)
      symmetric = symmetric && body.facts.velocity[d] == 0. &&
                  std::abs(0.5 * (body.low[d] + body.high[d]) - center) <
                      1e-6 * (body.high[d] - body.low[d]);
    if (symmetric)
      axes += std::string(axes.empty() ? "" : " and ") + "xyz"[d];
  }
  if (!axes.empty())
    plan.numbers.push_back({"planes of symmetry", "of boxes and velocities",
                            axes.size() > 1 ? 2. : 1.,
                            "the scene is its own mirror image in " + axes +
                                ": a part of it would give the same"});
}
} // namespace

PhysicsPlan plan_physics(const Scene &scene)
{
  PhysicsPlan plan;
  plan.bodies = find_body_facts(scene);
  plan.impact = find_impact(plan.bodies);
  judge_heat(scene, plan);
  if (plan.impact.exists)
    judge_impact(scene, plan);
  judge_zones_before(scene, plan);
  judge_hourglass_control(plan);
  judge_symmetry(plan);
  return plan;
}

void add_warnings(const PhysicsPlan &plan, Scene &scene)
{
  for (const std::string &warning : plan.warnings)
    if (std::find(scene.warnings.begin(), scene.warnings.end(), warning) ==
        scene.warnings.end())
      scene.warnings.push_back(warning);
}

nlohmann::ordered_json to_json(const PhysicsPlan &physics, const CostPlan &cost)
{
  using nlohmann::ordered_json;
  ordered_json plan;
  plan["numbers"] = ordered_json::array();
  for (const PlanNumber &n : physics.numbers)
    plan["numbers"].push_back({{"name", n.name},
                               {"formula", n.formula},
                               {"value", n.value},
                               {"verdict", n.verdict}});
  plan["warnings"] = physics.warnings;
  plan["problem"] = cost.problem;
  plan["bodies"] = ordered_json::object();
  for (const CostPlan::Item &item : cost.items)
    plan["bodies"][item.body] = {{item.kind, item.n},
                                 {"neighbors", item.neighbors}};
  plan["stable_step"] = cost.first_stable_step;
  plan["accuracy"] = cost.accuracy;
  plan["limiter"] = cost.limiter;
  for (const CostPlan::Conversion &c : cost.conversions)
    plan["conversions"][c.zone] = {{"host", c.host},
                                   {"particles", c.n_particles},
                                   {"first_time", c.first},
                                   {"last_time", c.last},
                                   {"basis", c.basis}};
  if (!cost.conversions.empty())
    plan["conversion_seconds"] = cost.conversion_seconds;
  plan["steps"] = cost.steps;
  plan["seconds_per_step"] = cost.seconds_per_step;
  plan["wall_seconds"] = cost.seconds;
  plan["memory_bytes"] = cost.memory_bytes;
  plan["output_bytes"] = cost.output_bytes;
  plan["checkpoint_bytes"] = cost.checkpoint_bytes;
  plan["calibration_steps"] = cost.calibration_steps;
  return plan;
}

std::string to_text(const PhysicsPlan &physics, const CostPlan &cost)
{
  std::string out = "What the scene needs\n";
  for (const PlanNumber &n : physics.numbers)
    out += "  " + n.name + " = " + text("%.3g", n.value) + "  (" + n.formula +
           ")\n      " + n.verdict + "\n";
  for (const std::string &warning : physics.warnings)
    out += "warning: " + warning + "\n";
  if (!cost.problem.empty())
    out += "warning: the run goes wrong in step " +
           std::to_string(cost.calibration_steps) + ": " + cost.problem + "\n";
  out += "What it costs\n";
  for (const CostPlan::Item &item : cost.items)
    out +=
        "  " + item.body + ": " + text("%.0f ", item.n) + item.kind +
        (item.neighbors > 0. ? text(" with %.1f neighbors each", item.neighbors)
                             : "") +
        "\n";
  for (const CostPlan::Conversion &c : cost.conversions)
    out +=
        "  cells of " + c.host + " that turn into " + c.zone + ": " +
        (c.n_particles > 0.
             ? text("to about %.0f particles", c.n_particles) +
                   text(", from %.3g to %.3g us\n", 1e6 * c.first, 1e6 * c.last)
             : "none is foreseen\n") +
        "      " + c.basis + "\n";
  if (!cost.conversions.empty())
    out += text(cost.conversion_seconds < 0. ? "      which saves %.3g s"
                                             : "      which adds %.3g s",
                std::abs(cost.conversion_seconds)) +
           "; measured up to 2 km/s: within a factor of 2 in particles and "
           "cost (doc/performance.md)\n";
  out += "  stable step " + text("%.3g s", cost.first_stable_step) +
         " at the start, limited by " + cost.limiter + "\n";
  out += "  steps " +
         text("%.0f, %.3g s each", cost.steps, cost.seconds_per_step) +
         text(" (measured over the first %.0f)\n", cost.calibration_steps);
  out += "  time " +
         (cost.seconds < 120. ? text("%.0f s", cost.seconds)
                              : text("%.1f minutes", cost.seconds / 60.)) +
         " on this machine, as busy as it is now\n";
  out += "  accuracy " + cost.accuracy + ": " + Accuracy::price(cost.accuracy) +
         "\n";
  out += text("  memory %.0f MB, files %.1f MB", 1e-6 * cost.memory_bytes,
              1e-6 * cost.output_bytes) +
         text(", each checkpoint %.1f MB\n", 1e-6 * cost.checkpoint_bytes);
  return out;
}
} // namespace sabot
