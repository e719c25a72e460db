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

void FemConversion::content_of(const std::size_t e, NodalMatter::Entry &all,
                               double *const states) const
{
  const Hexahedra &cells = body.cells;
  all.reference_volume = cells.volume[e];
  all.mass = body.material.density() * all.reference_volume;
  all.volume = cells.volume_ratio(e) * all.reference_volume;
  all.internal_energy = cells.internal_energy(e);
  all.plastic_work = cells.plastic_work(e);
  all.hourglass_energy = cells.hourglass_energy[e];
  all.gradient = cells.mean_gradient(e);
  for (std::size_t c = 0; c < n_symmetric; ++c)
    all.stress[c] = cells.stress(c, e);
  all.viscous_pressure = cells.viscous_pressure(e);
  all.elastic_energy =
      all.volume * elastic_energy_density(all.stress, body.material);
  cells.mean_states(e, states);
}

std::vector<SplitMesh::Member> FemConversion::members(const std::size_t e) const
{
  if (lattices)
    return lattices->members(body.cells.cell_id[e]);
  constexpr double side[8][3] = {{-.5, -.5, -.5}, {.5, -.5, -.5}, {.5, .5, -.5},
                                 {-.5, .5, -.5},  {-.5, -.5, .5}, {.5, -.5, .5},
                                 {.5, .5, .5},    {-.5, .5, .5}};
  std::vector<SplitMesh::Member> corners;
  for (int a = 0; a < 8; ++a)
    corners.push_back({body.nodes.global_id[body.cells.connectivity[e][a]],
                       0.125,
                       {{side[a][0], side[a][1], side[a][2]}}});
  return corners;
}

std::size_t FemConversion::local_node(const GlobalIndex node) const
{
  const auto &ids = body.nodes.global_id;
  const auto middle = ids.begin() + body.nodes.n_owned;
  auto found = std::lower_bound(ids.begin(), middle, node);
  if (found == middle || *found != node)
    found = std::lower_bound(middle, ids.end(), node);
  return found != ids.end() && *found == node ? found - ids.begin()
                                              : ids.size();
}

FemConversion::Carrier FemConversion::carrier_of(const GlobalIndex site) const
{
  if (!lattices)
    return {{local_node(site)}, {1.}};
  const SplitMesh::Carrier on = lattices->carrier(site);
  Carrier carrier;
  for (int a = 0; a < on.n; ++a)
  {
    carrier.node.push_back(local_node(on.node[a]));
    carrier.weight.push_back(on.weight[a]);
  }
  return carrier;
}

bool FemConversion::owns(const GlobalIndex site) const
{
  const GlobalIndex lowest = lattices ? lattices->carrier(site).node[0] : site;
  return local_node(lowest) < body.nodes.n_owned;
}

bool FemConversion::is_bare(const NodalMatter::Entry &entry) const
{
  if (!lattices)
    return body.living().bare_nodes()[entry.node];
  const auto around = lattices->cells_around(lattices->carrier(entry.site));
  return std::none_of(around.begin(), around.end(),
                      [&](const GlobalIndex cell)
                      { return body.living().has(cell); });
}

NodalMatter FemConversion::begin(const std::vector<std::size_t> &leaving) const
{
  std::vector<GlobalIndex> involved;
  for (const std::size_t e : leaving)
    for (const SplitMesh::Member &member : members(e))
      if (owns(member.site))
        involved.push_back(member.site);
  std::sort(involved.begin(), involved.end());
  involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
  NodalMatter matter;
  matter.n_rows = count_states(body.cells.states());
  matter.entries.resize(involved.size());
  matter.states.assign(involved.size() * matter.n_rows, 0.);
  for (std::size_t k = 0; k < involved.size(); ++k)
  {
    NodalMatter::Entry &entry = matter.entries[k];
    entry.site = involved[k];
    const Carrier on = carrier_of(entry.site);
    if (on.node.size() == 1)
    {
      entry.node = on.node[0];
      entry.position = body.nodes.position[entry.node];
      entry.velocity = body.nodes.velocity[entry.node];
      continue;
    }
    for (std::size_t a = 0; a < on.node.size(); ++a)
    {
      entry.position += on.weight[a] * body.nodes.position[on.node[a]];
      entry.velocity += on.weight[a] * body.nodes.velocity[on.node[a]];
    }
  }
  return matter;
}

NodalMatter
FemConversion::give(const std::vector<std::size_t> &leaving,
                    const std::vector<NodalMatter::Entry> &particles)
{
  const Hexahedra &cells = body.cells;
  if (lattices)
    refresh_velocities();
  NodalMatter matter = begin(leaving);
  const CornerFields fields(cells, body.nodes, body.exchange, leaving,
                            particles);
  const bool holds_modes = cells.holds_hourglass_energy();
  std::vector<double> states(matter.n_rows);
  std::vector<char> has_cell(matter.entries.size(), 0);
  for (const std::size_t e : leaving) // in the order of cells, on every rank
  {
    NodalMatter::Entry all;
    content_of(e, all, states.data());
    for (const SplitMesh::Member &member : members(e))
    {
      const auto found = std::lower_bound(
          matter.entries.begin(), matter.entries.end(), member.site,
          [](const NodalMatter::Entry &entry, const GlobalIndex site)
          { return entry.site < site; });
      if (found == matter.entries.end() || found->site != member.site)
        continue;
      const std::size_t k = found - matter.entries.begin();
      NodalMatter::Entry share = all;
      for (double *const part :
           {&share.mass, &share.reference_volume, &share.volume,
            &share.internal_energy, &share.plastic_work,
            &share.hourglass_energy, &share.elastic_energy})
        *part *= member.share;
      if (!holds_modes)
      {
        dissipated_modes.add(share.hourglass_energy);
        share.hourglass_energy = 0.;
      }
      fields.move_to(e, member.middle, share);
      matter.add(k, share, states.data());
      if (!has_cell[k])
        found->cell = cells.cell_id[e];
      has_cell[k] = 1;
    }
    for (const std::uint32_t a : cells.connectivity[e])
      if (a < body.nodes.n_owned)
        body.nodes.lumped_mass[a] -= 0.125 * all.mass;
  }
  body.living().take_out(leaving, false);
  finish(matter, fields);
  body.surface_has_changed(); // of some rank at least: all ask for it anew
  return matter;
}

void FemConversion::finish(NodalMatter &matter, const CornerFields &fields)
{
  for (NodalMatter::Entry &entry : matter.entries)
    entry.is_bare = is_bare(entry);
  matter.finish();
  for (NodalMatter::Entry &entry : matter.entries)
  {
    fields.bound(carrier_of(entry.site).node, entry);
    entry.gradient = std::cbrt(entry.volume / entry.reference_volume /
                               determinant(entry.gradient)) *
                     entry.gradient;
  }
  // Round-off of the differences: a node without cells and without eroded mass
  // has none, and its particle has all.
  constexpr double round_off = 1e-9;
  for (NodalMatter::Entry &entry : matter.entries)
  {
    if (entry.node == NodalMatter::no_node || !entry.is_bare)
      continue;
    double &rest = body.nodes.lumped_mass[entry.node];
    if (std::abs(rest) > round_off * entry.mass)
      continue;
    entry.mass += rest;
    rest = 0.;
  }
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
