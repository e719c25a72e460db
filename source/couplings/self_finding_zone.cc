// Cells that turn into particles, and the nodes that both share.
#include "sabot/couplings/self_finding_zone.h"

#include <algorithm>

namespace sabot
{
std::vector<int> SelfFindingZone::joins() const
{
  return {options.zone, options.host};
}

SelfFindingZone::SelfFindingZone(const std::string &name,
                                 const std::vector<Body *> &bodies,
                                 const SelfFindingOptions &options,
                                 MPI_Comm communicator,
                                 const std::shared_ptr<TiedNodes> &others)
    : Coupling(name), options(options), zone(*bodies[options.zone]),
      host(*bodies[options.host]), source(*host.cell_source()),
      sink(*zone.particle_sink()), communicator(communicator), others(others)
{
}

void SelfFindingZone::initialize()
{
  sink.live_with(host.node_owner);
  source.split_by(sink.lattices());
  if (sink.lattices())
    lattice = std::make_unique<LatticeFollowers>(
        LatticeFollowers::Parts{zone, host, source, sink, communicator});
  std::vector<GlobalIndex> kept;
  if (others)
    for (const auto *const nodes : {&others->followers, &others->leaders})
      for (const auto &[node, tie] : *nodes)
        if (node.first == options.host)
          kept.push_back(node.second);
  std::sort(kept.begin(), kept.end());
  source.keep_around(kept);
  if (options.is_start)
    convert(source.cells_in(options.is_start), 0);
}

bool SelfFindingZone::change_bodies(const unsigned int step)
{
  if (told)
  {
    const std::vector<std::size_t> cells = source.cells_in(told);
    told = nullptr;
    return convert(cells, step);
  }
  if (step % options.interval != 0)
    return false;
  std::vector<char> is_failed(host.nodes().size(), 0);
  const auto mark = [&](const std::vector<Shared> &pairs)
  {
    for (const Shared &pair : pairs)
      if (is_failing[pair.particle])
        is_failed[pair.node] = 1;
  };
  is_failing.assign(zone.nodes().n_owned, 0);
  const std::vector<std::size_t> failing = sink.failed_particles();
  for (const std::size_t i : failing)
    is_failing[i] = 1;
  mark(shared);
  mark(alone);
  if (lattice)
    lattice->mark(failing, is_failed);
  return convert(source.unfit_cells(is_failed), step);
}

bool SelfFindingZone::convert(const std::vector<std::size_t> &cells,
                              const unsigned int step)
{
  int any = !cells.empty();
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    return false;
  // Nodes have their particles' forces: back to those of cells and couplings.
  take_back();
  std::vector<NodalMatter::Entry> beside;
  for (const Shared &pair : shared)
  {
    beside.push_back(sink.content(pair.particle));
    beside.back().node = pair.node;
  }
  std::vector<LatticeFollowers::Turning> turned;
  if (lattice)
    turned = lattice->gather(cells);
  const NodalMatter matter = source.give(cells, beside);
  for (const NodalMatter::Entry &entry : matter.entries)
  {
    hourglass.add(entry.hourglass_energy);
    converted_mass.add(entry.mass);
    converted_energy.add(entry.internal_energy);
  }
  const std::size_t before = zone.nodes().n_owned;
  sink.take(matter, step, lost);
  pair_new(before);
  settle_pairs(matter);
  if (lattice)
  {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const Shared &pair : shared)
      pairs.emplace_back(pair.particle, pair.node);
    lattice->settle(matter, turned, pairs);
    impose_kinematics(); // of what has been kicked
  }
  hand_on();
  return true;
}

bool SelfFindingZone::is_at_node(const std::size_t i) const
{
  return !lattice ||
         sink.sites()[zone.nodes().global_id[i]] < sink.lattices()->n_nodes();
}

SelfFindingZone::Shared SelfFindingZone::pair_of(const std::size_t i) const
{
  const NodalState &nodes = host.nodes(), &particles = zone.nodes();
  const GlobalIndex id = sink.sites()[particles.global_id[i]];
  const auto node = std::lower_bound(
      nodes.global_id.begin(), nodes.global_id.begin() + nodes.n_owned, id);
  return {i, std::size_t(node - nodes.global_id.begin())};
}

void SelfFindingZone::pair_new(const std::size_t first)
{
  for (std::size_t i = first; i < zone.nodes().n_owned; ++i)
    if (is_at_node(i))
      shared.push_back(pair_of(i));
}

void SelfFindingZone::settle_pairs(const NodalMatter &matter)
{
  // A node without cells and mass hands over all that acts on it, and goes
  // along; one that eroded cells have left a mass stays and leads.
  NodalState &nodes = host.nodes(), &particles = zone.nodes();
  std::vector<char> goes(nodes.n_owned, 0);
  for (const NodalMatter::Entry &entry : matter.entries)
    if (entry.node != NodalMatter::no_node)
      goes[entry.node] = entry.is_bare && nodes.lumped_mass[entry.node] == 0.;
  std::size_t kept = 0;
  for (const Shared &pair : shared)
  {
    if (!goes[pair.node])
    {
      particles.inertia[pair.particle] = 0.;
      shared[kept++] = pair;
      continue;
    }
    sink.set_free(pair.particle);
    particles.force[pair.particle] += nodes.force[pair.node];
    nodes.force[pair.node] = Vec{};
    nodes.inertia[pair.node] = 0.;
    alone.push_back(pair);
  }
  shared.resize(kept);
}

void SelfFindingZone::take_back()
{
  if (lattice)
    lattice->take_back();
  NodalState &nodes = host.nodes();
  for (std::size_t k = 0; k < shared.size(); ++k)
    nodes.force[shared[k].node] -= handed[k];
}

void SelfFindingZone::hand_on()
{
  NodalState &nodes = host.nodes();
  const NodalState &particles = zone.nodes();
  handed.resize(shared.size());
  for (std::size_t k = 0; k < shared.size(); ++k)
  {
    handed[k] = particles.force[shared[k].particle];
    nodes.force[shared[k].node] += handed[k];
  }
  if (lattice)
    lattice->hand_on();
}

void SelfFindingZone::impose_kinematics()
{
  NodalState &nodes = host.nodes(), &particles = zone.nodes();
  for (const Shared &pair : shared)
    particles.velocity[pair.particle] = nodes.velocity[pair.node];
  for (const Shared &pair : alone)
    nodes.velocity[pair.node] = particles.velocity[pair.particle];
  if (lattice)
    lattice->impose_kinematics();
}

void SelfFindingZone::add_forces(const double)
{
  hand_on();
}

void SelfFindingZone::forward_changes()
{
  take_back();
  hand_on();
}

void SelfFindingZone::add_energies(EnergyLedger &ledger) const
{
  ledger.conversion.add(lost);
  ledger.conversion.add(hourglass);
  if (lattice)
    ledger.conversion.add(lattice->lost());
}

Measures SelfFindingZone::measure() const
{
  ExactSum mass = converted_mass, energy = converted_energy, gone = lost,
           modes = hourglass;
  ExactSum kinetic;
  if (lattice)
    kinetic = lattice->lost();
  ExactSum::reduce({&mass, &energy, &gone, &modes, &kinetic}, communicator);
  Measures measures{{"converted mass", "kg", mass.value()},
                    {"particles", "1", double(sink.sites().size())},
                    {"energy of what was converted", "J", energy.value()},
                    {"energy lost by means", "J", gone.value()},
                    {"hourglass energy lost", "J", modes.value()}};
  if (lattice)
    measures.push_back(
        {"kinetic energy lost to lattices", "J", kinetic.value()});
  return measures;
}

void SelfFindingZone::visit_state(StateVisitor &visitor)
{
  visitor.visit_sum("energy lost", lost);
  visitor.visit_sum("hourglass energy lost", hourglass);
  visitor.visit_sum("converted mass", converted_mass);
  visitor.visit_sum("converted energy", converted_energy);
  const StateItems particles = nodes_of_state(zone);
  const std::size_t n = particles.n_saved;
  std::vector<char> is_alone(n, 0);
  AlignedVector<Vec> forces(n, Vec{});
  for (const Shared &pair : alone)
    is_alone[pair.particle] = 1;
  for (std::size_t k = 0; k < handed.size(); ++k)
    forces[shared[k].particle] = handed[k];
  visitor.visit_items("particles alone", is_alone, particles);
  visitor.visit_items("forces handed on", forces, particles);
  if (lattice)
    lattice->visit_state(visitor);
  if (!visitor.is_restoring())
    return;
  shared.clear();
  alone.clear();
  handed.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (is_alone[i])
      alone.push_back(pair_of(i));
    else if (is_at_node(i))
    {
      shared.push_back(pair_of(i));
      handed.push_back(forces[i]);
    }
}
} // namespace sabot
