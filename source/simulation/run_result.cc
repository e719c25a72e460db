#include "sabot/base/parameter_file.h"
#include "sabot/output/file_tools.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/zone_verdict.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace sabot
{
namespace
{
using nlohmann::ordered_json;

/** JSON has no not-a-number. */
ordered_json number(const double value)
{
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

double cpu_seconds(const rusage &usage)
{
  return usage.ru_utime.tv_sec + usage.ru_stime.tv_sec +
         1e-6 * (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

ordered_json zone_results(const std::vector<ZoneVerdict> &verdicts)
{
  ordered_json zones = ordered_json::object();
  const auto reached = [](const double distance)
  {
    const bool anywhere = distance < std::numeric_limits<double>::max();
    return ordered_json{
        {"reached", anywhere},
        {"distance_from_tie_in_spacings",
         anywhere ? ordered_json(distance) : ordered_json(nullptr)}};
  };
  const auto box = [](const ZoneVerdict::Box &b)
  {
    return ordered_json{{"size", b.size},
                        {"particles", b.n_particles},
                        {"seconds_saved", number(b.seconds_saved)}};
  };
  for (const ZoneVerdict &v : verdicts)
    zones[v.zone] = {
        {"carved_from", v.host},
        {"spacing", v.spacing},
        {"particles", v.n_particles},
        {"plastic_strain_over_0.01", reached(v.plastic_distance)},
        {"broken_bonds", reached(v.bond_distance)},
        {"smallest_zone", box(v.for_both)},
        {"smallest_zone_for_broken_bonds", box(v.for_bonds)},
        {"is_lower_bound", v.is_lower_bound()},
        {"verdict", v.bond_distance <= 0.      ? "bonds broke at the tie"
                    : v.plastic_distance <= 0. ? "plastic flow passed the tie"
                                               : "contained"}};
  return zones;
}

/** How many pieces there are, and the heaviest; nothing for a body that cannot
    come apart. Collective. */
void add_fragments(const Body &body, ordered_json &result)
{
  constexpr std::size_t most = 20;
  if (body.fragments() == nullptr)
    return;
  const std::vector<Fragment> fragments = body.fragments()->connected_pieces();
  if (fragments.empty())
    return;
  result["fragment_count"] = fragments.size();
  result["fragments"] = ordered_json::array();
  for (std::size_t f = 0; f < std::min(most, fragments.size()); ++f)
  {
    const Fragment &piece = fragments[f];
    result["fragments"].push_back({{"particles", piece.n_particles},
                                   {"mass", piece.mass},
                                   {"velocity", piece.velocity}});
  }
}

/** Every entry that trades speed for accuracy, as it is in force. */
ordered_json knob_results(const Parameters &prm)
{
  static const std::vector<std::string>
      of_bodies = {"Discretization",
                   "Nodal spacing",
                   "Size",
                   "Cell size",
                   "Coarsest cell size",
                   "Growth ratio",
                   "Core radius",
                   "Refined zone size",
                   "Sector",
                   "Symmetry faces",
                   "Integration",
                   "Inversion",
                   "Erosion plastic strain",
                   "Erosion damage",
                   "Erosion step",
                   "Normalised support size",
                   "Kernel update interval",
                   "Failure check interval",
                   "Stabilisation coefficient",
                   "Hourglass control",
                   "Hourglass coefficient",
                   "Linear bulk viscosity",
                   "Quadratic bulk viscosity",
                   "Mass scaling"},
      of_couplings = {"Type", "Stiffness scale", "Damping fraction",
                      "Contact distance", "Tolerance"};
  std::ostringstream text;
  print_parameters(prm, "json", text);
  const ordered_json tree = ordered_json::parse(text.str());
  ordered_json knobs = ordered_json::object();
  const auto value = [](const ordered_json &node, const std::string &entry)
  { return node[entry].value("value", ""); };
  for (const char *const entry :
       {"Step factor", "Largest step", "List of couplings"})
    knobs[entry] = value(tree, entry);
  const auto collect = [&](const std::string &section, const std::string &list,
                           const std::vector<std::string> &entries)
  {
    for (const std::string &name : split_names(value(tree, list)))
      for (const std::string &entry : entries)
        if (tree[section][name].contains(entry))
          knobs[section + "/" + name + "/" + entry] =
              value(tree[section][name], entry);
  };
  collect("Bodies", "List of bodies", of_bodies);
  collect("Couplings", "List of couplings", of_couplings);
  return knobs;
}
} // namespace

ordered_json Run::body_results() const
{
  ordered_json bodies = ordered_json::object();
  for (const auto &body : scene.bodies)
  {
    ordered_json b;
    b[body->item_name()] = body->n_items();
    const BodyMeasures measures = body->measure();
    b["mass"] = number(measures.mass);
    b["velocity"] = ordered_json::array();
    for (const double component : measures.velocity)
      b["velocity"].push_back(number(component));
    for (const Measure &m : measures.columns())
    {
      if (m.name.compare(0, 9, "velocity ") == 0)
        continue;
      std::string key = m.name;
      std::replace(key.begin(), key.end(), ' ', '_');
      b[key] = number(m.value);
    }
    b["bonds_broken_fraction"] = number(measures.bonds_broken_fraction);
    b["eroded_mass"] = number(measures.eroded_mass);
    add_fragments(*body, b);
    bodies[body->name] = b;
  }
  return bodies;
}

ordered_json Run::timer_results() const
{
  ordered_json result = ordered_json::object();
  for (const auto &[name, phase] : timers.all())
  {
    // Items: what the loop runs over, on all ranks, per call.
    double items = 0.;
    for (const auto &body : scene.bodies)
      if (name == body->step_timer_name())
        items += body->n_items();
    ordered_json t;
    t["seconds"] = phase.seconds;
    t["calls"] = phase.calls;
    int n_bodies = 0;
    for (const auto &body : scene.bodies)
      n_bodies += name == body->step_timer_name();
    t["ns_per_item"] = items > 0.
                           ? ordered_json(1e9 * phase.seconds * n_ranks *
                                          n_bodies / (items * phase.calls))
                           : ordered_json(nullptr);
    result[name] = t;
  }
  return result;
}

void Run::write_result(const std::string &status, const std::string &reason)
{
  const Measures values = quantities();
  ordered_json r;
  r["title"] = scene.settings.title;
  r["version"] = version();
  r["status"] = status;
  r["reason"] = reason;
  r["ranks"] = n_ranks;
  r["steps"] = stepper.steps();
  r["time"] = stepper.time();
  r["wall_seconds"] = elapsed_seconds();
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  double sums[2] = {cpu_seconds(usage), 1024. * usage.ru_maxrss};
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator);
  r["cpu_seconds"] = sums[0];
  r["peak_memory_bytes"] = static_cast<std::int64_t>(sums[1]);
  r["energy_residual_max"] = number(largest_residual);
  r["momentum_residual_max"] =
      scene.is_free ? number(largest_momentum_residual) : ordered_json(nullptr);
  r["stable_step_min"] =
      stepper.steps() > 0 ? number(smallest_step) : ordered_json(nullptr);
  r["bodies"] = body_results();
  r["quantities"] = ordered_json::object();
  for (const Measure &m : values)
    r["quantities"][m.name] = {{"value", number(m.value)}, {"unit", m.unit}};
  r["energy"] = ordered_json::object();
  for (const Measure &m : ledger)
    if (m.unit == "J")
      r["energy"][m.name] = number(m.value);
  r["timers"] = timer_results();
  double penetration = 0., initial = 0.;
  for (const auto &coupling : scene.couplings)
    for (const Measure &m : coupling->measure())
    {
      if (m.name == "penetration max over spacing")
        penetration = std::max(penetration, m.value);
      if (m.name == "initial penetration over spacing")
        initial = std::max(initial, m.value);
    }
  r["contact"] = {{"penetration_max_over_spacing", number(penetration)},
                  {"initial_penetration_over_spacing", number(initial)}};
  // Where energy went between the bodies: contact and friction of each.
  r["couplings"] = ordered_json::object();
  for (const auto &coupling : scene.couplings)
  {
    ordered_json &entry = r["couplings"][coupling->name];
    entry["type"] = coupling->kind();
    for (const Measure &m : coupling->measure())
    {
      std::string key = m.name;
      std::replace(key.begin(), key.end(), ' ', '_');
      entry[key] = number(m.value);
    }
  }
  const std::vector<ZoneVerdict> zones =
      judge_zones(scene, timers, stepper.steps(), communicator);
  r["zone"] = zone_results(zones);
  r["knobs"] = knob_results(scene.prm);

  std::string problem;
  if (rank == 0)
    try
    {
      write_text(folder + "/result.json", r.dump(2) + "\n");
    }
    catch (const IOError &e)
    {
      problem = e.what();
    }
  int bad = !problem.empty();
  MPI_Bcast(&bad, 1, MPI_INT, 0, communicator);
  if (bad)
    throw IOError(problem.empty() ? "rank 0 could not write its output"
                                  : problem);

  char text[200];
  std::snprintf(text, sizeof(text),
                "%s: %u steps to %.4e s in %.1f s; energy residual %.2e",
                status.c_str(), stepper.steps(), stepper.time(),
                r["wall_seconds"].get<double>(), largest_residual);
  log.line(text);
  for (const ZoneVerdict &zone : zones)
    log.line("  " + describe(zone));
  for (const Measure &m : values)
  {
    std::snprintf(text, sizeof(text), "  %s: %.6g %s", m.name.c_str(), m.value,
                  m.unit.c_str());
    log.line(text);
  }
}
} // namespace sabot
