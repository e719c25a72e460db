// What result.json says of a run.
#include "sabot/simulation/run_result.h"

#include "sabot/simulation/found_zone.h"

#include "sabot/simulation/run.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

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

/** What zones that find themselves have found; nothing where there are none.
    Collective. */
void add_found_zones(const Scene &scene, ordered_json &r, MPI_Comm communicator)
{
  for (const FoundZone &found : find_grown(scene, communicator))
  {
    std::array<double, 3> size, center;
    for (int d = 0; d < 3; ++d)
    {
      size[d] = found.high[d] - found.low[d];
      center[d] = 0.5 * (found.low[d] + found.high[d]);
    }
    r["found_zones"][found.zone] = {{"host", found.host},
                                    {"particles", found.n_particles},
                                    {"size", size},
                                    {"center", center}};
  }
}

/** A measure's name as a key. */
std::string json_key(std::string name)
{
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
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
                                   {"copies", piece.copies},
                                   {"velocity", piece.velocity}});
  }
}

/** Force now and impulse since the start of each source on each body. */
void add_resultants(const std::vector<Resultant> &resultants,
                    const Scene &scene, ordered_json &entry)
{
  const auto vector = [](const std::array<double, 3> &v) {
    return ordered_json{number(v[0]), number(v[1]), number(v[2])};
  };
  for (const Resultant &r : resultants)
    entry["resultants"].push_back({{"source", r.source},
                                   {"body", scene.bodies[r.body]->name},
                                   {"force", vector(r.force)},
                                   {"impulse", vector(r.impulse)}});
}

ordered_json body_results(const Scene &scene, const ControlShares &shares)
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
      b[json_key(m.name)] = number(m.value);
    }
    if (!measures.control.empty())
      b[measures.control + "_over_internal"] = number(shares.share(body->id));
    b["bonds_broken_fraction"] = number(measures.bonds_broken_fraction);
    b["eroded_mass"] = number(measures.eroded_mass);
    add_fragments(*body, b);
    add_resultants(scene.reactions(*body), scene, b);
    bodies[body->name] = b;
  }
  return bodies;
}

ordered_json timer_results(const Timers &timers, const int n_ranks)
{
  ordered_json result = ordered_json::object();
  for (const auto &[name, phase] : timers.all())
  {
    ordered_json &t = result[name];
    t["seconds"] = phase.seconds;
    t["cpu_seconds"] = phase.cpu_seconds;
    t["calls"] = phase.calls;
    t["items"] = phase.items;
    t["ns_per_item"] = phase.items > 0.
                           ? ordered_json(1e9 * phase.cpu_seconds / phase.items)
                           : ordered_json(nullptr);
    if (n_ranks == 1)
      continue;
    t["messages"] = phase.messages.messages;
    t["message_bytes"] = phase.messages.message_bytes;
    t["reductions"] = phase.messages.reductions;
    t["gathers"] = phase.messages.gathers;
    t["gathered_bytes"] = phase.messages.gathered_bytes;
  }
  return result;
}

/** Steps over those that the undeformed particles or cells need by themselves,
    and what limited how many. */
ordered_json step_results(const Scene &scene, const StepShares &steps,
                          const RunSummary &summary)
{
  ordered_json r;
  const bool is_known = steps.own_step() > 0.;
  r["own_step_of"] =
      is_known ? ordered_json(steps.own_step_of()) : ordered_json(nullptr);
  r["own_step_at_rest"] =
      is_known ? ordered_json(steps.own_step()) : ordered_json(nullptr);
  r["steps_over_own"] = is_known && summary.time > 0.
                            ? number(steps.ratio(summary.steps, summary.time))
                            : ordered_json(nullptr);
  r["limited_by"] = ordered_json::array();
  for (const StepShares::Row &row : steps.rows())
    r["limited_by"].push_back(
        {{"name", row.name},
         {"kind", row.kind},
         {"steps", row.steps},
         {"share", double(row.steps) / steps.all_steps()}});
  r["substeps"] = ordered_json::object();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (summary.substeps[b] > 1.)
      r["substeps"][scene.bodies[b]->name] = summary.substeps[b];
  return r;
}

ordered_json message_results(const std::vector<MessageRates> &rates)
{
  ordered_json r;
  for (const MessageRates &rate : rates)
    r[rate.name] = {{"mean", rate.mean}, {"largest", rate.largest}};
  return r;
}

/** Deepest penetration of all contacts, and where each coupling's energy
    went. */
void add_couplings(const Scene &scene, ordered_json &r)
{
  double penetration = 0., initial = 0.;
  ordered_json couplings = ordered_json::object();
  for (const auto &coupling : scene.couplings)
  {
    ordered_json &entry = couplings[coupling->name];
    entry["type"] = coupling->kind();
    for (const Measure &m : coupling->measure())
    {
      if (m.name == "penetration max over spacing")
        penetration = std::max(penetration, m.value);
      if (m.name == "initial penetration over spacing")
        initial = std::max(initial, m.value);
      entry[json_key(m.name)] = number(m.value);
    }
    add_resultants(coupling->resultants(), scene, entry);
  }
  r["contact"] = {{"penetration_max_over_spacing", number(penetration)},
                  {"initial_penetration_over_spacing", number(initial)}};
  r["couplings"] = couplings;
}

/** What each load did; nothing for a scene without. Collective. */
void add_loads(const Scene &scene, ordered_json &r)
{
  for (const auto &load : scene.loads)
  {
    ordered_json &entry = r["loads"][load->name];
    entry["type"] = load->type();
    entry["work"] = number(load->total_work());
    add_resultants(load->resultants(), scene, entry);
  }
}

/** Processor time and memory of all ranks. */
void add_resources(ordered_json &r, MPI_Comm communicator)
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  double sums[2] = {cpu_seconds(usage), 1024. * usage.ru_maxrss};
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator);
  r["cpu_seconds"] = sums[0];
  r["peak_memory_bytes"] = static_cast<std::int64_t>(sums[1]);
}
} // namespace

ordered_json make_result(const Scene &scene, const RunSummary &summary,
                         const EnergyBalance &balance, const ForceBook &forces,
                         const ControlShares &shares, const StepShares &steps,
                         const Timers &timers,
                         const std::vector<ZoneVerdict> &zones,
                         MPI_Comm communicator)
{
  ordered_json r;
  r["title"] = scene.settings.title;
  r["version"] = version();
  r["status"] = summary.status;
  r["reason"] = summary.reason;
  r["warnings"] = scene.warnings;
  r["ranks"] = summary.n_ranks;
  r["steps"] = summary.steps;
  r["time"] = summary.time;
  r["wall_seconds"] = summary.wall_seconds;
  add_resources(r, communicator);
  r["energy_residual_max"] = number(balance.largest_residual());
  r["momentum_residual_max"] =
      number(scene.is_free ? balance.largest_momentum_residual()
                           : forces.largest_momentum_residual());
  r["stable_step_min"] =
      summary.steps > 0 ? number(summary.smallest_step) : ordered_json(nullptr);
  r["bodies"] = body_results(scene, shares);
  r["quantities"] = ordered_json::object();
  // A state that went wrong has numbers, but they answer nothing.
  const bool is_valid = summary.status != "failed";
  for (const auto &quantity : scene.quantities)
  {
    ordered_json &entry = r["quantities"][quantity->name];
    entry = {
        {"value", is_valid ? number(quantity->value()) : ordered_json(nullptr)},
        {"unit", quantity->unit()}};
    for (const Measure &m : quantity->details())
      if (is_valid)
        entry[json_key(m.name)] = number(m.value);
  }
  r["energy"] = ordered_json::object();
  for (const Measure &m : balance.row())
    if (m.unit == "J")
      r["energy"][m.name] = number(m.value);
  r["timers"] = timer_results(timers, summary.n_ranks);
  r["step_limits"] = step_results(scene, steps, summary);
  r["messages_per_step"] = message_results(summary.messages);
  add_couplings(scene, r);
  add_loads(scene, r);
  r["zone"] = zone_results(zones);
  add_found_zones(scene, r, communicator);
  r["knobs"] = ordered_json::object();
  for (const auto &[path, value] : scene.knobs())
    r["knobs"][path] = value;
  return r;
}
} // namespace sabot
