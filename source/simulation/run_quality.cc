// What the end of a run tells of how far its answer is to be trusted.
#include "sabot/simulation/run_quality.h"

#include "sabot/base/error.h"
#include "sabot/base/text.h"
#include "sabot/bodies/mass_scaling.h"

#include <algorithm>
#include <cstdio>

namespace sabot
{
namespace
{
/** Penetration over spacing from which on contact is no surface any more. */
constexpr double deep = 0.5;

std::string percent(const double share)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %%", 100. * share);
  return text;
}

/** What else a body can do against hourglass modes than what it does. */
std::string instead_of_control(const BodyFacts &facts)
{
  const bool may_yield = facts.material->initial_yield_stress().has_value();
  std::string text = " or \"Integration = B-bar\", which has no such modes";
  const std::string best = may_yield ? "viscous" : "stiffness";
  if (facts.hourglass_control != best)
    text += "; \"Hourglass control = " + best + "\" suits a body that " +
            (may_yield ? "yields" : "never yields");
  return text;
}

/** What a body of particles can do that the stabilization takes less, of which
    metal that has failed has the part @p of_failed. */
std::string instead_of_stabilization(const BodyFacts &facts,
                                     const double of_failed)
{
  const std::string shocks =
      !facts.largest_shock ? "use finer particles"
      : *facts.largest_shock < BodyFacts::wide_shock
          ? "against shocks that shake particles set \"Normalized support size "
            "= 2.5\" or \"Approximation = convex exponential\""
          : "against shocks that shake particles set \"Approximation = convex "
            "exponential\"";
  return of_failed > 0.5
             ? percent(of_failed) +
                   " of it is in metal that has failed, where it acts like "
                   "friction between pieces and finer particles hardly change "
                   "it (doc/penetration.md)"
             : shocks + (facts.largest_shock ? ", otherwise use finer particles"
                                             : "");
}

bool holds_only_rigid(const Coupling &coupling,
                      const std::vector<std::unique_ptr<Body>> &bodies)
{
  const auto pairs = coupling.holds_apart();
  return !pairs.empty() &&
         std::none_of(pairs.begin(), pairs.end(),
                      [&](const std::pair<int, int> &pair)
                      {
                        return bodies[pair.first]->facts().deforms ||
                               bodies[pair.second]->facts().deforms;
                      });
}
} // namespace

void check_rigid_penetration(const Scene &scene)
{
  // Bodies that deform may be crushed beyond recognition; rigid ones cannot.
  constexpr double through = 1.;
  for (const auto &coupling : scene.couplings)
  {
    if (!holds_only_rigid(*coupling, scene.bodies))
      continue;
    for (const Measure &m : coupling->measure())
      if (m.name == "penetration max over spacing" && m.value > through)
      {
        double closing = 0.;
        for (const auto &other : scene.couplings)
          for (const Measure &n : other->measure())
            if (n.name == "closing per step over spacing max")
              closing = n.value;
        char text[300];
        std::snprintf(
            text, sizeof(text),
            "rigid bodies in contact \"%s\" went into each other by "
            "%.3g spacings, closing in by up to %.3g spacings a step; "
            "set \"Largest step\" so that a step closes less, or "
            "refine their \"Cell size\"",
            coupling->name.c_str(), m.value, closing);
        throw PhysicsError(text);
      }
  }
}

void describe_residual(const double residual, const RunSettings &settings,
                       Log &log)
{
  // Stable steps leave 1e-5 to 2e-3 on shipped scenes.
  constexpr double much = 0.005;
  if (residual > much)
    log.warning("the energy balance is off by up to " + percent(residual) +
                ": steps are too long for some mesh or contact; compare with a "
                "\"Step factor\" less than " +
                formatted("%.3g", settings.step_factor));
}

void describe_quality(const Scene &scene, const ControlShares &shares,
                      const double energy_scale, Log &log)
{
  for (const auto &body : scene.bodies)
  {
    const BodyMeasures measures = body->measure();
    const std::string &control = measures.control;
    if (control.empty())
      continue;
    const double of_failed =
        measures.control_energy > 0.
            ? measures.control_in_failed / measures.control_energy
            : 0.;
    const std::string share = control + " energy of body \"" + body->name +
                              "\" is " + percent(shares.share(body->id)) +
                              " of its internal energy (largest of the run)";
    if (!shares.is_large(body->id, energy_scale))
      log.line("  " + share);
    else
      log.warning(share + ", more than " + percent(ControlShares::most) +
                  ": the answer depends on it; " +
                  (control == "hourglass"
                       ? "use finer " + body->item_name() +
                             instead_of_control(body->facts())
                       : instead_of_stabilization(body->facts(), of_failed)));
  }
  for (const auto &body : scene.bodies)
    if (const MassScaling *const scaling = body->mass_scaling())
    {
      char text[64];
      std::snprintf(text, sizeof(text), "%.4g kg, ", scaling->added_mass());
      log.line("  mass scaling added " + (text + percent(scaling->share())) +
               " of the mass of body \"" + body->name + "\"");
    }
  for (const auto &coupling : scene.couplings)
    for (const Measure &m : coupling->measure())
      if (m.name == "penetration max over spacing" && m.value > 0.)
      {
        char text[64];
        std::snprintf(text, sizeof(text), "%.3g spacings", m.value);
        const std::string depth =
            "contact " + coupling->name + ": nodes went in by up to " + text;
        if (m.value > deep)
          log.warning(depth + "; a smaller \"Step factor\" or a larger "
                              "\"Stiffness scale\" makes it stiffer");
        else
          log.line("  " + depth);
      }
}
} // namespace sabot
