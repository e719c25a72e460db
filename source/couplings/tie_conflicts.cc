// Nodes of a tie that something else moves as well.
#include "sabot/couplings/tie_conflicts.h"
#include "sabot/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sabot
{
namespace
{
/** A node of which velocities are prescribed. */
struct HeldNode
{
  GlobalIndex id;
  std::array<double, 3> free, value; // by component
};

/** Nodes owned by this rank that are held. */
std::vector<HeldNode> held_here(const Body &body)
{
  std::vector<HeldNode> held;
  const NodalState &nodes = body.nodes();
  if (const VelocityConstraints *const prescribed = body.prescribed())
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const auto [free, value] = prescribed->held_at(i);
      if (free[0] * free[1] * free[2] == 0.)
        held.push_back({nodes.global_id[i],
                        {{free[0], free[1], free[2]}},
                        {{value[0], value[1], value[2]}}});
    }
  return held;
}

/** Nodes of all ranks that are held. Collective. */
std::map<GlobalIndex, HeldNode> held_nodes(const Body &body,
                                           MPI_Comm communicator)
{
  const std::vector<HeldNode> mine = held_here(body),
                              everywhere = gather_all(mine, communicator);
  std::map<GlobalIndex, HeldNode> all;
  for (const HeldNode &node : everywhere)
    all.emplace(node.id, node);
  return all;
}
} // namespace

std::string TieConflicts::place_of(const int body, const GlobalIndex node) const
{
  const NodalState &nodes = bodies[body]->nodes();
  double x[3] = {0., 0., 0.};
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (nodes.global_id[i] == node)
      for (int d = 0; d < 3; ++d)
        x[d] = nodes.reference_position[i][d];
  MPI_Allreduce(MPI_IN_PLACE, x, 3, MPI_DOUBLE, MPI_SUM, communicator);
  char text[100];
  std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g) mm", 1e3 * x[0],
                1e3 * x[1], 1e3 * x[2]);
  return text;
}

std::string
TieConflicts::leave_to_others(std::vector<TieConstraint> &constraints) const
{
  std::size_t n_left = 0;
  GlobalIndex first = -1;
  std::string holder;
  const auto is_tied = [&](const TieConstraint &c)
  {
    const auto other = others.followers.find({follower, c.follower});
    if (other == others.followers.end())
      return false;
    if (n_left++ == 0)
    {
      first = c.follower;
      holder = other->second;
    }
    return true;
  };
  constraints.erase(
      std::remove_if(constraints.begin(), constraints.end(), is_tied),
      constraints.end());
  for (const TieConstraint &c : constraints)
    others.followers.emplace(TiedNodes::Node(follower, c.follower), name);
  if (n_left == 0)
    return "";
  return std::to_string(n_left) +
         (n_left == 1 ? " node of body \"" : " nodes of body \"") +
         bodies[follower]->name + "\" on the surface of \"" +
         bodies[leader]->name + "\", the first at " +
         place_of(follower, first) + ", already follow in tie \"" + holder +
         "\" and are left to it";
}

void TieConflicts::refuse_chains(
    const std::vector<TieConstraint> &constraints) const
{
  const auto refuse =
      [&](const int body, const GlobalIndex node, const std::string &other)
  {
    throw InputError("Couplings/" + name,
                     "the node of body \"" + bodies[body]->name + "\" at " +
                         place_of(body, node) +
                         " follows in one of the ties "
                         "\"" +
                         name + "\" and \"" + other +
                         "\" and leads in the other; make the body that "
                         "touches both others the leader of both ties");
  };
  for (const TieConstraint &c : constraints)
  {
    const auto leads = others.leaders.find({follower, c.follower});
    if (leads != others.leaders.end())
      refuse(follower, c.follower, leads->second);
    for (int a = 0; a < 8; ++a)
    {
      const auto follows = others.followers.find({leader, c.leader[a]});
      if (c.weight[a] != 0. && follows != others.followers.end())
        refuse(leader, c.leader[a], follows->second);
    }
  }
  for (const TieConstraint &c : constraints)
    for (int a = 0; a < 8; ++a)
      if (c.weight[a] != 0.)
        others.leaders.emplace(TiedNodes::Node(leader, c.leader[a]), name);
}

void TieConflicts::refuse_held(
    const std::vector<TieConstraint> &constraints) const
{
  const auto held = held_nodes(*bodies[follower], communicator),
             held_leaders = held_nodes(*bodies[leader], communicator);
  constexpr double some = 1e-9; // a weight that is more than round-off
  std::size_t n = 0;
  GlobalIndex first = -1;
  bool of_component[3] = {false, false, false};
  for (const TieConstraint &c : constraints)
  {
    const auto at = held.find(c.follower);
    if (at == held.end())
      continue;
    bool agrees = true;
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d)
      {
        if (at->second.free[d] != 0. || std::abs(c.weight[a]) < some)
          continue;
        const auto of_leader = held_leaders.find(c.leader[a]);
        const bool same = of_leader != held_leaders.end() &&
                          of_leader->second.free[d] == 0. &&
                          of_leader->second.value[d] == at->second.value[d];
        of_component[d] = of_component[d] || !same;
        agrees = agrees && same;
      }
    if (!agrees && n++ == 0)
      first = c.follower;
  }
  if (n == 0)
    return;
  std::string components;
  for (int d = 0; d < 3; ++d)
    if (of_component[d])
      components += std::string(components.empty() ? "" : ", ") + "xyz"[d];
  throw InputError(
      "Couplings/" + name + "/Follower",
      std::to_string(n) + (n == 1 ? " node" : " nodes") + " of body \"" +
          bodies[follower]->name + "\", the first at " +
          place_of(follower, first) + ", would have to move with body \"" +
          bodies[leader]->name + "\" and to keep a prescribed velocity along " +
          components +
          " (clamped, driven or symmetry faces) that the nodes of "
          "\"" +
          bodies[leader]->name +
          "\" there do not have; give both bodies the same faces, or take the "
          "tied nodes out of one of the two conditions");
}
} // namespace sabot
