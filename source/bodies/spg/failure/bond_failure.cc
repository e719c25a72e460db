// Bonds that fail: found once, removed once, counted once.
#include "sabot/bodies/spg/failure/bond_failure.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/particle_conduction.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/spg_options.h"

#include <algorithm>

namespace sabot
{
BondFailure::BondFailure(const SpgOptions &options)
    : criterion(options.failure_criterion),
      critical_stretch(options.critical_stretch),
      interval(options.failure_check_interval),
      remembers_pairs(options.neighbor_policy ==
                      SpgOptions::NeighborPolicy::search)
{
}

void BondFailure::allocate(const std::size_t n_owned,
                           const ResidualStrength &rule)
{
  n_failed.assign(n_owned, 0);
  loss.assign(n_owned, 0.);
  is_failed.assign(n_owned, 0);
  crumbled.assign(n_owned, 0);
  joins_crumbled = rule.joins_crumbled();
  if (rule.has_friction())
    friction_work.assign(n_owned, 0.);
  if (remembers_pairs)
    failed_pairs.resize(n_owned);
}

void BondFailure::extend(const std::size_t n, const ResidualStrength &rule)
{
  crumbled.resize(n_failed.size());
  n_failed.resize(n, 0);
  loss.resize(n, 0.);
  is_failed.resize(n, 0);
  crumbled.resize(n, 0);
  if (rule.has_friction())
    friction_work.resize(n, 0.);
  if (remembers_pairs)
    failed_pairs.resize(n);
}

BondFailure::~BondFailure() = default;

void BondFailure::average_by(std::unique_ptr<ParticleConduction> averaging)
{
  this->averaging = std::move(averaging);
}

bool BondFailure::find_measure(const BondList &bonds,
                               const ParticleFields &fields,
                               const MaterialPoints &points,
                               MPI_Comm communicator)
{
  criterion->measure(points, fields, measure.data());
  if (!averaging)
    return true;
  double top = 0.;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (bonds.n_bonds(i) > 0) // what is loose drives nobody
      top = std::max(top, measure[i]);
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (top <= criterion->critical_value())
    return false;
  averaging->advance(1., measure.data());
  return true;
}

bool BondFailure::find(const NodalState &nodes, const BondList &bonds,
                       const ParticleFields &fields,
                       const MaterialPoints &points,
                       const ParticleExchange &exchange, MPI_Comm communicator)
{
  if (!criterion->can_be_met())
    return false;
  measure.resize(nodes.size());
  forget_marks();
  is_marked.assign(bonds.capacity(), 0);
  crumbles.assign(nodes.n_owned, 0);
  if (!find_measure(bonds, fields, points, communicator))
    return false;
  exchange.update(measure.data());
  // Only bonds with a strained end can fail (their mean exceeds the limit).
  const double critical = criterion->critical_value(),
               square = critical_stretch * critical_stretch;
  bool any = false;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      if (measure[i] + measure[j] <= 2. * critical || !is_cohesive(i, j))
        continue;
      const Vec now = nodes.position[j] - nodes.position[i],
                original =
                    nodes.reference_position[j] - nodes.reference_position[i];
      if (norm_square(now) <= square * norm_square(original))
        continue;
      const bool here = measure[i] > critical,
                 stays = joins_crumbled && here && measure[j] > critical;
      is_marked[b] = !stays;
      if (!stays && (with_marks.empty() || with_marks.back() != i))
        with_marks.push_back(i);
      crumbles[i] |= here;
      any = true;
    }
  return any;
}

void BondFailure::count(const NodalState &nodes, const BondList &bonds,
                        const ParticleExchange &exchange)
{
  if (!criterion->can_be_met())
    return;
  // Updates without a look before them find no marks.
  is_marked.resize(bonds.capacity(), 0);
  crumbles.resize(nodes.n_owned, 0);
  ++changes;
  // A bond fails once, whether it goes or stays without cohesion.
  const std::vector<char> before = crumbled;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    crumbled[i] |= crumbles[i];
  if (joins_crumbled)
    exchange.update(crumbled.data());
  auto row = with_marks.begin();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const bool has_marks = row != with_marks.end() && *row == i;
    row += has_marks;
    if (!has_marks && !crumbled[i])
      continue;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const bool held = !(joins_crumbled && before[i] && before[j]);
      n_failed[i] += is_marked[b] || (held && !is_cohesive(i, j));
      if (is_marked[b] && remembers_pairs)
        failed_pairs[i].push_back(nodes.global_id[j]);
    }
  }
  crumbles.clear();
}

bool BondFailure::remove(BondList &bonds)
{
  if (!criterion->can_be_met())
    return false;
  const bool has_changed = bonds.remove(is_marked);
  forget_marks();
  return has_changed;
}

bool BondFailure::remove_from_rows(BondList &bonds)
{
  const bool has_changed = bonds.remove(is_marked, with_marks);
  forget_marks();
  return has_changed;
}

void BondFailure::judge(const std::vector<char> &lost_direction,
                        const ResidualStrength &rule)
{
  for (std::size_t i = 0; i < is_failed.size(); ++i)
    is_failed[i] =
        rule.has_failed({bool(lost_direction[i]), bool(crumbled[i])});
}

bool BondFailure::renews_crumbled(MPI_Comm communicator) const
{
  if (!joins_crumbled)
    return false;
  int any = std::count(crumbled.begin(), crumbled.end(), 1) > 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  return any != 0;
}

void BondFailure::renew_ghosts(const ParticleExchange &exchange,
                               const std::size_t n_local)
{
  ++changes;
  crumbled.resize(n_local);
  if (joins_crumbled)
    exchange.update(crumbled.data());
}

std::size_t BondFailure::n_holding(const BondList &bonds,
                                   const std::size_t i) const
{
  if (!joins_crumbled || !crumbled[i])
    return bonds.n_bonds(i);
  std::size_t n = 0;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    n += is_cohesive(i, bonds.neighbor[b]);
  return n;
}

double BondFailure::failed_fraction(const BondList &bonds,
                                    const std::size_t i) const
{
  const double all = n_holding(bonds, i) + n_failed[i];
  return all > 0. ? n_failed[i] / all : 0.;
}

void BondFailure::visit_failed_pairs(StateVisitor &visitor,
                                     const StateItems &items)
{
  const StateItems owned = {items.name, items.keys, items.n_saved,
                            items.n_saved};
  std::vector<std::uint32_t> counts;
  for (const auto &of_particle : failed_pairs)
    counts.push_back(of_particle.size());
  visitor.visit_items("failed pair counts", counts, owned);
  std::vector<std::size_t> starts = {0};
  for (const std::uint32_t n : counts)
    starts.push_back(starts.back() + n);
  std::vector<GlobalIndex> pairs(starts.back());
  for (std::size_t i = 0; i < counts.size() && !visitor.is_restoring(); ++i)
    std::copy(failed_pairs[i].begin(), failed_pairs[i].end(),
              pairs.begin() + starts[i]);
  const StateRows rows = {owned, visitor.section + "/failed pairs",
                          starts.data(), counts.data()};
  visitor.visit_shape(rows);
  visitor.visit_rows("failed pairs", pairs, rows);
  for (std::size_t i = 0; i < counts.size() && visitor.is_restoring(); ++i)
    failed_pairs[i].assign(pairs.begin() + starts[i],
                           pairs.begin() + starts[i + 1]);
}

void BondFailure::visit_state(StateVisitor &visitor, const StateItems &items)
{
  changes += visitor.is_restoring();
  visitor.visit_items("failed bonds", n_failed, items);
  if (remembers_pairs)
    visit_failed_pairs(visitor, items);
  visitor.visit_items("failure loss", loss, items);
  visitor.visit_items("has failed", is_failed, items);
  visitor.visit_items("crumbled", crumbled, items);
  visitor.visit_items("rubble friction", friction_work, items);
}
} // namespace sabot
