// Prescribed velocities of nodes, and the work that they do.
#include "sabot/bodies/velocity_constraints.h"

#include <algorithm>

namespace sabot
{
void VelocityConstraints::prescribe(const std::size_t i, const int axis,
                                    const double velocity, const Holder by)
{
  collected[i][axis] = {true, velocity, by};
}

void VelocityConstraints::finish()
{
  held.clear();
  impulse.clear();
  append();
}

void VelocityConstraints::append()
{
  for (const auto &[node, axis] : collected)
  {
    held.push_back({node,
                    vec(!axis[0].is_held, !axis[1].is_held, !axis[2].is_held),
                    vec(axis[0].velocity, axis[1].velocity, axis[2].velocity),
                    {{axis[0].by, axis[1].by, axis[2].by}}});
    has_work = has_work || norm_square(held.back().value) > 0.;
  }
  impulse.resize(held.size(), Vec{});
  collected.clear();
}

std::pair<Vec, Vec> VelocityConstraints::held_at(const std::size_t i) const
{
  const auto at = std::lower_bound(held.begin(), held.end(), i,
                                   [](const Held &h, const std::size_t node)
                                   { return h.node < node; });
  if (at == held.end() || at->node != i)
    return {vec(1., 1., 1.), Vec{}};
  return {at->free, at->value};
}

void VelocityConstraints::impose(NodalState &nodes, const double factor)
{
  const double counts = has_started ? 1. : 0.;
  has_started = true;
  for (std::size_t k = 0; k < held.size(); ++k)
  {
    const Held &h = held[k];
    Vec &velocity = nodes.velocity[h.node];
    const Vec before = velocity;
    velocity = h.free * velocity + factor * h.value;
    impulse[k] += (counts * nodes.inertia[h.node]) * (velocity - before);
  }
}

std::vector<Resultant>
VelocityConstraints::reactions(const NodalState &nodes, const int body,
                               const std::vector<Holder> &kinds,
                               MPI_Comm communicator) const
{
  std::vector<ExactVectorSum> force(kinds.size()), total(kinds.size());
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    for (std::size_t k = 0; k < held.size(); ++k)
    {
      const Held &h = held[k];
      Vec its = {};
      for (int d = 0; d < 3; ++d)
        its[d] = h.free[d] == 0. && h.by[d] == kinds[kind];
      total[kind].add(its * impulse[k]);
      if (!nodes.is_follower(h.node))
        force[kind].add(-1. * (its * nodes.force[h.node]));
    }
  std::vector<ExactVectorSum *> sums;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    sums.insert(sums.end(), {&force[kind], &total[kind]});
  ExactVectorSum::reduce(sums, communicator);
  const char *const names[] = {"symmetry faces", "driven faces",
                               "clamped faces"};
  std::vector<Resultant> all;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    all.push_back({names[static_cast<int>(kinds[kind])], body,
                   force[kind].value(), total[kind].value(), true});
  return all;
}

std::vector<Resultant>
VelocityConstraints::reactions(const NodalState &nodes, const int body,
                               MPI_Comm communicator) const
{
  const std::array<Holder, 3> all = {
      {Holder::symmetry, Holder::drive, Holder::clamp}};
  int is_there[3] = {is_expected[0], is_expected[1], is_expected[2]};
  for (const Held &h : held)
    for (int d = 0; d < 3; ++d)
      if (h.free[d] == 0.)
        is_there[static_cast<int>(h.by[d])] = 1;
  MPI_Allreduce(MPI_IN_PLACE, is_there, 3, MPI_INT, MPI_MAX, communicator);
  std::vector<Holder> kinds;
  for (const Holder kind : all)
    if (is_there[static_cast<int>(kind)])
      kinds.push_back(kind);
  return reactions(nodes, body, kinds, communicator);
}

void VelocityConstraints::visit_state(StateVisitor &visitor,
                                      const std::string &body,
                                      const NodalState &nodes)
{
  std::vector<GlobalIndex> keys;
  for (const Held &h : held)
    keys.push_back(nodes.global_id[h.node]);
  const StateItems items = {visitor.section + "/held nodes of " + body,
                            keys.data(), keys.size(), keys.size()};
  visitor.visit_keys(items);
  visitor.visit_items("reaction impulse", impulse, items);
}

void VelocityConstraints::accumulate_work(const NodalState &nodes,
                                          const double half_dt,
                                          const double factor)
{
  if (!has_work)
    return;
  for (const Held &h : held)
    // A tied follower is moved by its leaders, whatever is prescribed.
    if (norm_square(h.value) > 0. && !nodes.is_follower(h.node))
      done.add(-half_dt * dot(nodes.kick_force(h.node), factor * h.value));
}

void VelocityConstraints::add_kick_energy(const NodalState &nodes,
                                          const double dt, ExactSum &sum) const
{
  ExactTerms terms(sum);
  auto next = held.begin();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const bool is_held = next != held.end() && next->node == i;
    if (!nodes.is_follower(i))
    {
      const Vec force = nodes.kick_force(i),
                f = is_held ? next->free * force : force;
      terms.add(dt * dt / (8. * nodes.inertia[i]) * norm_square(f));
    }
    next += is_held;
  }
}
} // namespace sabot
