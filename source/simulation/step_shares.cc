// Steps as a figure of merit: how many there were, what limited them, and what
// ranks told each other in them.
#include "sabot/simulation/step_shares.h"

#include "sabot/base/text.h"
#include "sabot/bodies/mass_scaling.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace sabot
{
namespace
{
constexpr double none = std::numeric_limits<double>::max();

enum Bound
{
  growth,
  largest,
  end_time,
  n_bounds
};
constexpr const char *bound_names[n_bounds] = {"growth of the step",
                                               "Largest step", "End time"};
} // namespace

StepShares::StepShares(const std::vector<std::unique_ptr<Body>> &bodies,
                       const std::vector<std::unique_ptr<Coupling>> &couplings,
                       const StepLimits &limits)
    : bodies(bodies), couplings(couplings), limits(limits),
      counts(2 * bodies.size() + couplings.size() + n_bounds, 0)
{
}

void StepShares::start(const std::vector<double> &own_steps)
{
  double of_particles = none, of_cells = none;
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    double &least = bodies[b]->particles() != nullptr ? of_particles : of_cells;
    least = std::min(least, own_steps[b]);
  }
  item_at_rest = of_particles < none ? "particles" : "cells";
  step_at_rest = of_particles < none ? of_particles
                 : of_cells < none   ? of_cells
                                     : 0.;
}

void StepShares::look(const StepProposal &proposal, const double dt,
                      const bool is_last)
{
  const std::size_t n = bodies.size(), source = proposal.source;
  const std::size_t first_bound = 2 * n + couplings.size();
  if (proposal.source < 0 || dt < limits.factor * proposal.dt)
  {
    const Bound bound = dt == limits.largest ? largest
                        : is_last            ? end_time
                                             : growth;
    ++counts[first_bound + bound];
    return;
  }
  if (source >= n)
  {
    ++counts[n + source];
    return;
  }
  const MassScaling *const scaling = bodies[source]->mass_scaling();
  const bool is_held = scaling != nullptr &&
                       proposal.dt <= scaling->smallest_step() * (1. + 1e-6);
  ++counts[2 * source + is_held];
}

double StepShares::ratio(const unsigned int n, const double time) const
{
  return time > 0. ? n * step_at_rest / time : 0.;
}

std::vector<StepShares::Row> StepShares::rows() const
{
  std::vector<Row> rows;
  std::size_t k = 0;
  const auto add = [&](const std::string &name, const std::string &kind)
  {
    if (counts[k] > 0)
      rows.push_back({name, kind, counts[k]});
    ++k;
  };
  for (const auto &body : bodies)
  {
    add(body->name, body->item_name());
    add(body->name, "mass scaling");
  }
  for (const auto &coupling : couplings)
    add(coupling->name, coupling->kind());
  for (const char *const name : bound_names)
    add(name, "bound");
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row &a, const Row &b)
                   { return a.steps > b.steps; });
  return rows;
}

std::int64_t StepShares::all_steps() const
{
  return std::accumulate(counts.begin(), counts.end(), std::int64_t(0));
}

std::vector<MessageRates> message_rates(const StepMessages &messages,
                                        MPI_Comm communicator)
{
  const MessageCount &m = messages.sum;
  const std::pair<const char *, std::int64_t> of_rank[] = {
      {"messages", m.messages},     {"message_bytes", m.message_bytes},
      {"reductions", m.reductions}, {"reduction_bytes", m.reduction_bytes},
      {"gathers", m.gathers},       {"gathered_bytes", m.gathered_bytes}};
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<MessageRates> rates;
  for (const auto &[name, count] : of_rank)
  {
    const double mine =
        messages.steps > 0 ? double(count) / messages.steps : 0.;
    MessageRates r{name, mine, mine};
    MPI_Allreduce(MPI_IN_PLACE, &r.mean, 1, MPI_DOUBLE, MPI_SUM, communicator);
    MPI_Allreduce(MPI_IN_PLACE, &r.largest, 1, MPI_DOUBLE, MPI_MAX,
                  communicator);
    r.mean /= n_ranks;
    rates.push_back(r);
  }
  return rates;
}

std::string describe_steps(const StepShares &shares, const unsigned int n,
                           const double time)
{
  const double ratio = shares.ratio(n, time);
  const std::int64_t all = shares.all_steps();
  if (!(ratio > 0.) || all == 0)
    return "";
  std::string line =
      formatted("steps: %.3g times as many as ", ratio) + shares.own_step_of() +
      formatted(" at rest need (%.3g s); limited by ", shares.own_step());
  std::string separator;
  for (const StepShares::Row &row : shares.rows())
  {
    line += separator + row.name +
            (row.kind == "bound" ? "" : ", " + row.kind) +
            formatted(", %.3g %%", 100. * row.steps / all);
    separator = "; ";
  }
  return line;
}

std::string describe_messages(const std::vector<MessageRates> &rates)
{
  return formatted("per step and rank: %.3g messages", rates[0].mean) +
         formatted(" of %.3g kB in all", 1e-3 * rates[1].mean) +
         formatted(", %.3g reductions", rates[2].mean) +
         formatted(", %.3g gathers", rates[4].mean) +
         formatted(" of %.3g kB", 1e-3 * rates[5].mean);
}
} // namespace sabot
