// Particles of split cells that follow the nodes of cells which are left.
#include "sabot/couplings/lattice_followers.h"

#include "sabot/base/gather_all.h"
#include "sabot/couplings/lattice_spin.h"

#include <algorithm>

namespace sabot
{
LatticeFollowers::LatticeFollowers(const Parts &parts)
    : body(parts), lattices(*parts.sink.lattices())
{
}

GlobalIndex LatticeFollowers::site_of(const std::size_t i) const
{
  return body.sink.sites()[body.zone.nodes().global_id[i]];
}

std::vector<LatticeFollowers::Turning>
LatticeFollowers::gather(const std::vector<std::size_t> &cells) const
{
  const NodalState &nodes = body.host.nodes();
  std::vector<Turning> mine;
  for (const std::size_t e : cells)
  {
    Turning turning{body.source.cell_number(e), {}};
    const auto &corners = lattices.nodes_of(turning.cell);
    const GlobalIndex lowest =
        *std::min_element(corners.begin(), corners.end());
    if (body.source.local_node(lowest) >= nodes.n_owned)
      continue;
    for (const GlobalIndex a : corners)
      turning.center += 0.125 * nodes.position[body.source.local_node(a)];
    mine.push_back(turning);
  }
  std::vector<Turning> all = gather_all(mine, body.communicator);
  std::sort(all.begin(), all.end(),
            [](const Turning &a, const Turning &b) { return a.cell < b.cell; });
  return all;
}

void LatticeFollowers::rebuild()
{
  const NodalState &particles = body.zone.nodes(), &nodes = body.host.nodes();
  owned.clear();
  std::vector<GlobalIndex> mine;
  for (std::size_t i = 0; i < particles.n_owned; ++i)
    if (site_of(i) >= lattices.n_nodes() && particles.is_follower(i))
    {
      owned.push_back(i);
      mine.push_back(particles.global_id[i]);
    }
  followers = gather_all(mine, body.communicator);
  std::sort(followers.begin(), followers.end());
  motion.clear();
  forces.clear();
  std::vector<GlobalIndex> remote;
  std::vector<int> remote_owner;
  std::size_t next_owned = 0;
  for (const GlobalIndex number : followers)
  {
    const SplitMesh::Carrier on = lattices.carrier(body.sink.sites()[number]);
    const bool is_mine =
        next_owned < owned.size() && mine[next_owned] == number;
    std::size_t slot = is_mine ? next_owned : owned.size() + remote.size();
    bool is_needed = false;
    for (int a = 0; a < on.n; ++a)
    {
      const std::size_t node = body.source.local_node(on.node[a]);
      if (is_mine)
        motion.push_back({owned[next_owned], node, on.weight[a]});
      if (node >= nodes.n_owned)
        continue;
      forces.push_back({node, slot, on.weight[a]});
      is_needed = true;
    }
    if (is_mine)
      ++next_owned;
    else if (is_needed)
    {
      remote.push_back(number);
      remote_owner.push_back(body.zone.node_owner[number]);
    }
  }
  exchange = GhostExchange(
      body.communicator, owned.size(), remote_owner, remote,
      [&](const GlobalIndex number) {
        return std::lower_bound(mine.begin(), mine.end(), number) -
               mine.begin();
      });
  force.assign(owned.size() + remote.size(), Vec{});
  leaders.clear();
  for (const Term &term : forces)
    leaders.push_back(term.leader);
  std::sort(leaders.begin(), leaders.end());
  leaders.erase(std::unique(leaders.begin(), leaders.end()), leaders.end());
  for (Term &term : forces)
    term.leader =
        std::lower_bound(leaders.begin(), leaders.end(), term.leader) -
        leaders.begin();
  handed.assign(leaders.size(), Vec{});
}

std::unordered_map<GlobalIndex, Mat>
LatticeFollowers::slopes(const std::vector<Turning> &turned) const
{
  struct Slope
  {
    GlobalIndex node;
    Mat gradient;
  };
  const NodalState &nodes = body.host.nodes();
  std::vector<GlobalIndex> wanted;
  for (const Turning &turning : turned)
    for (const GlobalIndex a : lattices.nodes_of(turning.cell))
      if (body.source.local_node(a) < nodes.n_owned)
        wanted.push_back(a);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  AlignedVector<Slope> mine;
  for (const GlobalIndex a : wanted)
  {
    Slope slope{a, Mat::zero()};
    double volume = 0.;
    for (const GlobalIndex cell : lattices.cells_around(lattices.carrier(a)))
    {
      const MeanGradients mean = lattices.gradients(cell);
      for (int b = 0; b < 8; ++b)
        add_outer(
            slope.gradient,
            nodes.velocity[body.source.local_node(lattices.nodes_of(cell)[b])],
            mean.volume * vec(mean.B[b][0], mean.B[b][1], mean.B[b][2]));
      volume += mean.volume;
    }
    slope.gradient = (1. / volume) * slope.gradient;
    mine.push_back(slope);
  }
  std::unordered_map<GlobalIndex, Mat> all;
  for (const Slope &slope : gather_all(mine, body.communicator))
    all[slope.node] = slope.gradient;
  return all;
}

std::vector<LatticeFollowers::Missing>
LatticeFollowers::release(const NodalMatter &matter,
                          const std::unordered_map<GlobalIndex, Mat> &slopes)
{
  NodalState &particles = body.zone.nodes();
  const NodalState &nodes = body.host.nodes();
  std::vector<Missing> released;
  for (const NodalMatter::Entry &entry : matter.entries)
  {
    if (!entry.is_bare || entry.node != NodalMatter::no_node)
      continue;
    const std::size_t i = *body.sink.particle_at(entry.site);
    body.sink.set_free(i);
    const SplitMesh::Carrier on = lattices.carrier(entry.site);
    const double m = particles.lumped_mass[i];
    const Vec x = particles.position[i], X = particles.reference_position[i];
    for (int a = 0; a < on.n; ++a)
    {
      const Vec from =
          nodes.reference_position[body.source.local_node(on.node[a])];
      particles.velocity[i] +=
          (0.5 * on.weight[a]) * (slopes.at(on.node[a]) * (X - from));
    }
    const Vec v = particles.velocity[i];
    Missing one{entry.cell, entry.site, -m * v, -m * cross(x, v)};
    double kinetic = -0.5 * m * norm_square(v);
    for (int a = 0; a < on.n; ++a)
    {
      const std::size_t node = body.source.local_node(on.node[a]);
      const double share = on.weight[a] * m;
      const Vec v_a = nodes.velocity[node];
      one.momentum += share * v_a;
      one.moment += share * cross(nodes.position[node], v_a);
      kinetic += 0.5 * share * norm_square(v_a);
    }
    lost_energy.add(kinetic);
    released.push_back(one);
  }
  return released;
}

void LatticeFollowers::set_inertia(
    const NodalMatter &matter, const std::vector<std::size_t> &old_leaders,
    const std::vector<std::pair<std::size_t, std::size_t>> &shared)
{
  NodalState &nodes = body.host.nodes();
  const NodalState &particles = body.zone.nodes();
  std::vector<double> mass(force.size());
  for (std::size_t s = 0; s < owned.size(); ++s)
    mass[s] = particles.lumped_mass[owned[s]];
  exchange.update(mass.data());
  std::vector<double> inertia = nodes.lumped_mass;
  for (const auto &[particle, node] : shared)
    inertia[node] += particles.lumped_mass[particle];
  for (const Term &term : forces)
    inertia[leaders[term.leader]] += term.weight * mass[term.slot];
  for (const std::vector<std::size_t> *const some :
       {&old_leaders, &std::as_const(leaders)})
    for (const std::size_t node : *some)
      nodes.inertia[node] = inertia[node];
  for (const NodalMatter::Entry &entry : matter.entries)
    if (entry.node != NodalMatter::no_node)
      nodes.inertia[entry.node] = inertia[entry.node];
}

void LatticeFollowers::settle(
    const NodalMatter &matter, const std::vector<Turning> &turned,
    const std::vector<std::pair<std::size_t, std::size_t>> &shared)
{
  const std::vector<Missing> missing = release(matter, slopes(turned));
  const std::vector<std::size_t> old_leaders = leaders;
  rebuild();
  set_inertia(matter, old_leaders, shared);
  const ExactSum gained =
      LatticeSpin(body, followers, turned).give_back(missing);
  lost_energy.subtract(gained);
}

void LatticeFollowers::impose_kinematics()
{
  body.source.refresh_velocities();
  const NodalState &nodes = body.host.nodes();
  NodalState &particles = body.zone.nodes();
  for (const std::size_t i : owned)
    particles.velocity[i] = Vec{};
  for (const Motion &term : motion)
    particles.velocity[term.particle] +=
        term.weight * nodes.velocity[term.node];
}

void LatticeFollowers::hand_on()
{
  NodalState &nodes = body.host.nodes();
  const NodalState &particles = body.zone.nodes();
  for (std::size_t s = 0; s < owned.size(); ++s)
    force[s] = particles.force[owned[s]];
  exchange.update(force.data());
  std::fill(handed.begin(), handed.end(), Vec{});
  for (const Term &term : forces)
    handed[term.leader] += term.weight * force[term.slot];
  for (std::size_t k = 0; k < leaders.size(); ++k)
    nodes.force[leaders[k]] += handed[k];
}

void LatticeFollowers::take_back()
{
  NodalState &nodes = body.host.nodes();
  for (std::size_t k = 0; k < leaders.size(); ++k)
    nodes.force[leaders[k]] -= handed[k];
}

void LatticeFollowers::mark(const std::vector<std::size_t> &failing,
                            std::vector<char> &is_failed) const
{
  std::vector<GlobalIndex> sites;
  for (const std::size_t i : failing)
    if (site_of(i) >= lattices.n_nodes())
      sites.push_back(site_of(i));
  for (const GlobalIndex site : gather_all(sites, body.communicator))
  {
    const SplitMesh::Carrier on = lattices.carrier(site);
    for (int a = 0; a < on.n; ++a)
    {
      const std::size_t node = body.source.local_node(on.node[a]);
      if (node < body.host.nodes().n_owned)
        is_failed[node] = 1;
    }
  }
}

void LatticeFollowers::visit_state(StateVisitor &visitor)
{
  visitor.visit_sum("kinetic energy lost to lattices", lost_energy);
  const StateItems nodes = nodes_of_state(body.host);
  AlignedVector<Vec> forces_of_nodes(nodes.n_saved, Vec{});
  for (std::size_t k = 0; k < leaders.size(); ++k)
    forces_of_nodes[leaders[k]] = handed[k];
  visitor.visit_items("forces of followers", forces_of_nodes, nodes);
  if (!visitor.is_restoring())
    return;
  rebuild();
  for (std::size_t k = 0; k < leaders.size(); ++k)
    handed[k] = forces_of_nodes[leaders[k]];
}
} // namespace sabot
