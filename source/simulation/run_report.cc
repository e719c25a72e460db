// What a run tells its log: where it comes from, what it is made of, how it
// goes.
#include "sabot/simulation/run_report.h"

#include "sabot/base/program.h"
#include "sabot/bodies/mass_scaling.h"
#include "sabot/simulation/run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
namespace
{
std::string format(const char *pattern, const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
  return text;
}
} // namespace

void RunReport::describe_program(const int n_ranks) const
{
  const ProgramFacts &facts = program_facts();
  log.line("Sabot " + version() +
           (facts.revision.empty() ? "" : ", revision " + facts.revision) +
           (scene.settings.title.empty() ? "" : ": " + scene.settings.title));
  log.line("  " + place_text() + ", " + std::to_string(n_ranks) +
           (n_ranks == 1 ? " rank" : " ranks"));
  if (!facts.command.empty())
    log.line("  command: " + facts.command);
  log.line("  compiled by " + build_text());
}

void RunReport::describe_scene() const
{
  for (const auto &body : scene.bodies)
    log.line("  body " + body->name + ": " + std::to_string(body->n_items()) +
             " " + body->item_name());
  for (const std::string &note : scene.notes)
    log.line("  " + note);
  for (const std::string &warning : scene.warnings)
    log.warning(warning);
  for (const auto &coupling : scene.couplings)
    for (const Measure &m : coupling->measure())
    {
      if (m.name == "tied nodes")
        log.line("  tie " + coupling->name + ": " + format("%.0f", m.value) +
                 " nodes");
      constexpr double noise = 1e-9; // of what only touches
      if (m.name == "initial penetration over spacing" && m.value > noise)
        log.warning("contact " + coupling->name +
                    ": nodes start inside the other body by up to " +
                    format("%.3g", m.value) + " spacings");
    }
}

std::string RunReport::progress_text(const RunProgress &now) const
{
  const double done = now.time / scene.settings.end_time;
  const double left = done > 0. ? now.wall * (1. - done) / done : 0.;
  char text[256];
  std::snprintf(text, sizeof(text),
                "step %6u  time %.4e s (%3.0f %%)  dt %.3e s (%s)  energy "
                "residual %.2e  ETA %.0f s",
                now.step, now.time, 100. * done, now.dt, now.limiter.c_str(),
                balance.last_residual(), left);
  return text;
}

std::string RunReport::energy_text() const
{
  std::string text;
  for (const Measure &m : balance.row())
    if (m.unit == "J" && (m.value != 0. || m.name == "total"))
      text += (text.empty() ? "" : ", ") + m.name + format(" %.5g", m.value);
  return text + " J";
}

std::string RunReport::added_mass_text() const
{
  std::string text;
  for (const auto &body : scene.bodies)
    if (const MassScaling *const scaling = body->mass_scaling())
      text += "; added mass of " + body->name +
              format(" %.3g %%", 100. * scaling->share());
  return text;
}

void RunReport::progress(const RunProgress &now)
{
  if (log.wants_progress())
    log.progress(progress_text(now));
  const int percent =
      std::floor(100. * now.time / scene.settings.end_time * (1. + 1e-9));
  const int minute = std::floor(now.wall_since_start / 60.);
  if (percent <= said_percent && minute <= said_minute)
    return;
  said_percent = percent;
  said_minute = minute;
  log.record(progress_text(now) + "  " + energy_text() + added_mass_text());
}
} // namespace sabot
