// Cells that turn into particles: verdicts, and what goes to their corners.
#include "sabot/bodies/fem/fem_conversion.h"

#include "sabot/bodies/body_report.h"
#include "sabot/bodies/fem/cell_conditions.h"
#include "sabot/bodies/fem/corner_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
void FemConversion::convert_by(
    std::vector<std::shared_ptr<const ConversionCriterion>> all)
{
  on = true;
  criteria = std::move(all);
}

void FemConversion::set_up(const std::vector<GlobalIndex> &held)
{
  keep_around(held);
  if (std::any_of(criteria.begin(), criteria.end(),
                  [](const auto &c) { return c->needs_steps(); }))
    body.cells.cell_step.assign(body.cells.size(),
                                std::numeric_limits<double>::max());
}

void FemConversion::keep_around(const std::vector<GlobalIndex> &nodes)
{
  const Hexahedra &cells = body.cells;
  stays.resize(body.living().n_initial(), 0);
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (const std::uint32_t a : cells.connectivity[e])
      if (std::binary_search(nodes.begin(), nodes.end(),
                             body.nodes.global_id[a]))
        stays[body.living().initial_number(e)] = 1;
}

std::vector<std::size_t>
FemConversion::unfit_cells(std::vector<char> &is_failed)
{
  const Hexahedra &cells = body.cells;
  const LivingCells &living = body.living();
  body.exchange.update(is_failed.data());
  if (start_steps.empty() && !cells.cell_step.empty())
  {
    start_steps.resize(living.n_initial());
    for (std::size_t e = 0; e < cells.size(); ++e)
      start_steps[living.initial_number(e)] = cells.cell_step[e];
  }
  FemCellConditions conditions(body.nodes, body.exchange, cells, living,
                               start_steps, is_failed);
  std::vector<char> unfit(cells.size(), 0);
  for (const auto &criterion : criteria)
    criterion->mark(conditions, unfit);
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < unfit.size(); ++e)
    if (unfit[e] && may_turn(e))
      found.push_back(e);
  return found;
}

std::vector<std::size_t> FemConversion::cells_in(
    const std::function<bool(const std::array<double, 3> &)> &is_inside) const
{
  const std::vector<char> none(body.nodes.size(), 0);
  const auto centers = FemCellConditions(body.nodes, body.exchange, body.cells,
                                         body.living(), start_steps, none)
                           .centers();
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < centers.size(); ++e)
    if (may_turn(e) && is_inside(centers[e]))
      found.push_back(e);
  return found;
}

void FemConversion::share_of(const std::size_t e, NodalMatter::Entry &share,
                             double *const states) const
{
  const Hexahedra &cells = body.cells;
  share.reference_volume = 0.125 * cells.volume[e];
  share.mass = body.material.density() * share.reference_volume;
  const double J = cells.volume_ratio(e);
  share.volume = J * share.reference_volume;
  share.internal_energy = 0.125 * cells.internal_energy(e);
  share.plastic_work = 0.125 * cells.plastic_work(e);
  share.hourglass_energy = 0.125 * cells.hourglass_energy[e];
  share.gradient = cells.mean_gradient(e);
  for (std::size_t c = 0; c < n_symmetric; ++c)
    share.stress[c] = cells.stress(c, e);
  share.viscous_pressure = cells.viscous_pressure(e);
  share.elastic_energy =
      share.volume * elastic_energy_density(share.stress, body.material);
  cells.mean_states(e, states);
}

NodalMatter
FemConversion::give(const std::vector<std::size_t> &leaving,
                    const std::vector<NodalMatter::Entry> &particles)
{
  const Hexahedra &cells = body.cells;
  NodalMatter matter;
  std::vector<std::size_t> involved;
  for (const std::size_t e : leaving)
    for (const std::uint32_t a : cells.connectivity[e])
      if (a < body.nodes.n_owned)
        involved.push_back(a);
  std::sort(involved.begin(), involved.end());
  involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
  matter.n_rows = count_states(cells.states());
  matter.entries.resize(involved.size());
  matter.states.assign(involved.size() * matter.n_rows, 0.);
  for (std::size_t k = 0; k < involved.size(); ++k)
    matter.entries[k].node = involved[k];

  const CornerFields fields(cells, body.nodes, body.exchange, leaving,
                            particles);
  const bool holds_modes = cells.holds_hourglass_energy();
  std::vector<double> states(matter.n_rows);
  for (const std::size_t e : leaving) // in the order of cells, on every rank
  {
    NodalMatter::Entry share;
    share_of(e, share, states.data());
    const double modes = share.hourglass_energy;
    if (!holds_modes)
      share.hourglass_energy = 0.;
    for (int corner = 0; corner < 8; ++corner)
    {
      const std::uint32_t a = cells.connectivity[e][corner];
      if (a >= body.nodes.n_owned)
        continue;
      const std::size_t k =
          std::lower_bound(involved.begin(), involved.end(), a) -
          involved.begin();
      NodalMatter::Entry there = share;
      fields.move_to(e, corner, there);
      matter.add(k, there, states.data());
      if (!holds_modes)
        dissipated_modes.add(modes);
      body.nodes.lumped_mass[a] -= share.mass;
    }
  }
  body.living().take_out(leaving, false);
  for (NodalMatter::Entry &entry : matter.entries)
    entry.is_bare = body.living().bare_nodes()[entry.node];
  matter.finish();
  for (NodalMatter::Entry &entry : matter.entries)
  {
    fields.bound(entry);
    entry.gradient = std::cbrt(entry.volume / entry.reference_volume /
                               determinant(entry.gradient)) *
                     entry.gradient;
  }
  // Round-off of the differences: a node without cells and without eroded mass
  // has none, and its particle has all.
  constexpr double round_off = 1e-9;
  for (NodalMatter::Entry &entry : matter.entries)
  {
    double &rest = body.nodes.lumped_mass[entry.node];
    if (!entry.is_bare || std::abs(rest) > round_off * entry.mass)
      continue;
    entry.mass += rest;
    rest = 0.;
  }
  body.surface_has_changed(); // of some rank at least: all ask for it anew
  return matter;
}

void FemConversion::visit_state(StateVisitor &visitor,
                                const StateItems &initial_cells)
{
  // A rank without cells cannot tell by itself.
  int knows_steps = !start_steps.empty();
  visitor.visit_largest("steps of the start are known", knows_steps);
  if (knows_steps)
    start_steps.resize(initial_cells.n_held);
  visitor.visit_items("steps of the start", start_steps, initial_cells);
  visitor.visit_sum("dissipated hourglass energy", dissipated_modes);
}
} // namespace sabot
