// Prescribed velocities of nodes, and the work that they do.
#include "sabot/bodies/velocity_constraints.h"

#include <algorithm>

namespace sabot
{
void VelocityConstraints::prescribe(const std::size_t i, const int axis,
                                    const double velocity)
{
  const auto entry =
      collected.emplace(i, std::array<std::array<double, 2>, 3>{
                               {{{1., 0.}}, {{1., 0.}}, {{1., 0.}}}});
  entry.first->second[axis] = {{0., velocity}};
}

void VelocityConstraints::finish()
{
  held.clear();
  for (const auto &[node, axis] : collected)
  {
    held.push_back({node, vec(axis[0][0], axis[1][0], axis[2][0]),
                    vec(axis[0][1], axis[1][1], axis[2][1])});
    has_work = has_work || norm_square(held.back().value) > 0.;
  }
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

void VelocityConstraints::impose(NodalState &nodes) const
{
  for (const Held &h : held)
    nodes.velocity[h.node] = h.free * nodes.velocity[h.node] + h.value;
}

void VelocityConstraints::accumulate_work(const NodalState &nodes,
                                          const double half_dt)
{
  if (!has_work)
    return;
  for (const Held &h : held)
    // A tied follower is moved by its leaders, whatever is prescribed.
    if (norm_square(h.value) > 0. && !nodes.is_follower(h.node))
      done.add(-half_dt * dot(nodes.force[h.node], h.value));
}
} // namespace sabot
