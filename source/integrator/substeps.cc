// Bodies that make several steps within one of the scene.
#include "sabot/integrator/substeps.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void Substeps::find(const std::vector<std::unique_ptr<Body>> &bodies,
                    const std::vector<std::unique_ptr<Load>> &loads,
                    const std::vector<std::unique_ptr<Coupling>> &couplings,
                    const unsigned int largest)
{
  most = largest;
  members.clear();
  // The body with the longest step makes one, so that it takes two.
  const auto may = [](const auto &body) { return body->moves_node_by_node(); };
  if (most == 1 || std::count_if(bodies.begin(), bodies.end(), may) < 2)
    return;
  std::vector<char> bound(bodies.size(), 0);
  for (const auto &coupling : couplings)
    for (const int b : coupling->joins())
      bound[b] = 1;
  for (const auto &load : loads)
    for (const int b : load->drives())
      bound[b] = 1;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!bound[b] && bodies[b]->moves_node_by_node())
    {
      members.push_back({bodies[b].get(), 1, {}, 0});
      members.back().own.resize(bodies[b]->nodes().n_owned, Vec{});
    }
  before.resize(members.size());
}

Substeps::Member *Substeps::of(const Body &body)
{
  const auto at =
      std::find_if(members.begin(), members.end(),
                   [&](const Member &m) { return m.body == &body; });
  return at == members.end() ? nullptr : &*at;
}

const Substeps::Member *Substeps::of(const std::size_t b) const
{
  const auto at =
      std::find_if(members.begin(), members.end(),
                   [b](const Member &m) { return m.body->id == int(b); });
  return at == members.end() ? nullptr : &*at;
}

unsigned int Substeps::Member::next(const double shares) const
{
  constexpr double round_off = 1e-9, margin = 0.25;
  const unsigned int least = std::max(1., std::ceil(shares - round_off));
  return least < n && shares > least - margin ? least + 1 : least;
}

void Substeps::bound(const std::vector<std::unique_ptr<Body>> &bodies,
                     const std::vector<double> &own, double &step,
                     std::size_t &decides) const
{
  double longest = 0.;
  std::size_t its = bodies.size();
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    const double bound = of(b) != nullptr ? most * own[b] : own[b];
    if (bound < step)
    {
      step = bound;
      decides = b;
    }
    if (bodies[b]->moves_node_by_node() && own[b] > longest)
    {
      longest = own[b];
      its = b;
    }
  }
  if (its < bodies.size() && longest < step)
  {
    step = longest;
    decides = its;
  }
}

void Substeps::change_kick(Member &member)
{
  AlignedVector<Vec> &change = member.body->nodes().kick_change;
  if (member.n == 1)
    return change.clear();
  change.resize(member.own.size());
  const double part = 1. / member.n - 1.;
  for (std::size_t i = 0; i < change.size(); ++i)
    change[i] = part * member.own[i];
}

void Substeps::take(const std::vector<unsigned int> &counts)
{
  for (Member &member : members)
  {
    member.n = counts.empty() ? 1 : counts[member.body->id];
    member.body->nodes().n_substeps = member.n;
    change_kick(member);
  }
}

void Substeps::begin(const std::vector<unsigned int> &counts)
{
  take(counts);
  for (Member &member : members)
    member.made += member.n;
}

void Substeps::keep_own(Member &member)
{
  NodalState &nodes = member.body->nodes();
  std::copy_n(nodes.force.begin(), member.own.size(), member.own.begin());
  if (member.n == 1)
    return;
  const double part = 1. / member.n;
  for (std::size_t i = 0; i < member.own.size(); ++i)
    nodes.force[i] = part * member.own[i];
}

void Substeps::complete()
{
  for (Member &member : members)
  {
    if (member.n > 1)
    {
      NodalState &nodes = member.body->nodes();
      const double part = 1. - 1. / member.n;
      for (std::size_t i = 0; i < member.own.size(); ++i)
        nodes.force[i] += part * member.own[i];
    }
    change_kick(member);
  }
}

void Substeps::before_update()
{
  for (std::size_t m = 0; m < members.size(); ++m)
    before[m].assign(members[m].body->nodes().force.begin(),
                     members[m].body->nodes().force.begin() +
                         members[m].own.size());
}

void Substeps::after_update()
{
  for (std::size_t m = 0; m < members.size(); ++m)
  {
    Member &member = members[m];
    const AlignedVector<Vec> &force = member.body->nodes().force;
    for (std::size_t i = 0; i < member.own.size(); ++i)
      member.own[i] += force[i] - before[m][i];
    change_kick(member);
  }
}

void Substeps::visit_state(StateVisitor &visitor)
{
  for (Member &member : members)
  {
    visitor.visit_value("substeps of " + member.body->name, member.n);
    visitor.visit_value("substeps made by " + member.body->name, member.made);
    visitor.visit_items("own force of " + member.body->name, member.own,
                        nodes_of_state(*member.body));
    if (visitor.is_restoring())
    {
      member.body->nodes().n_substeps = member.n;
      change_kick(member);
    }
  }
}
} // namespace sabot
