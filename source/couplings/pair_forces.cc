// Which body does what to which in a coupling of more than two.
#include "sabot/couplings/pair_forces.h"

#include <set>

namespace sabot
{
PairForces::PairForces(const std::vector<std::pair<int, int>> &pairs,
                       const std::vector<Body *> &bodies)
{
  std::set<std::pair<int, int>> directed;
  std::set<int> members;
  for (const auto &[a, b] : pairs)
  {
    directed.insert({{a, b}, {b, a}});
    members.insert({a, b});
  }
  if (members.size() <= 2)
    return;
  n_bodies = bodies.size();
  side_of.assign(n_bodies * n_bodies, -1);
  for (const auto &[on, by] : directed)
  {
    side_of[on * n_bodies + by] = sides.size();
    sides.push_back({on, by, bodies[by]->name});
  }
  impulses.resize(sides.size());
}

void PairForces::add(const NodeHalo &halo, const std::size_t slot,
                     const std::size_t other, const Vec force)
{
  if (slot < halo.n_owned())
    pushes.push_back(
        {std::size_t(
             side_of[halo.key(slot).body * n_bodies + halo.key(other).body]),
         force});
}

void PairForces::accumulate(const double half_dt)
{
  for (const Push &push : pushes)
    impulses[push.side].add(half_dt * push.force);
}

std::vector<Resultant> PairForces::resultants(const std::string &source,
                                              MPI_Comm communicator) const
{
  std::vector<ExactVectorSum> force(sides.size()), total = impulses;
  for (const Push &push : pushes)
    force[push.side].add(push.force);
  std::vector<ExactVectorSum *> sums;
  for (std::size_t s = 0; s < sides.size(); ++s)
    sums.insert(sums.end(), {&force[s], &total[s]});
  ExactVectorSum::reduce(sums, communicator);
  std::vector<Resultant> all;
  for (std::size_t s = 0; s < sides.size(); ++s)
    all.push_back({source + " by " + sides[s].by_name, sides[s].on,
                   force[s].value(), total[s].value(), false});
  return all;
}

void PairForces::visit_state(StateVisitor &visitor)
{
  if (!any())
    return;
  // Half of their impulse is still to come.
  visitor.visit_anywhere("forces of pairs", pushes);
  visitor.visit_sums("impulses of pairs", impulses);
}
} // namespace sabot
