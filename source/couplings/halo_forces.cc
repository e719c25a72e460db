// Forces of a contact at the slots of its halo, and their work.
#include "sabot/couplings/halo_forces.h"

#include <algorithm>
#include <set>

namespace sabot
{
void HaloForces::resize(const std::size_t n)
{
  settle_impulses();
  normal.assign(n, Vec{});
  friction.assign(n, Vec{});
  total.assign(n, Vec{});
}

void HaloForces::clear()
{
  std::fill(normal.begin(), normal.end(), Vec{});
  std::fill(friction.begin(), friction.end(), Vec{});
  pairs.clear();
}

void HaloForces::add_to_bodies(const NodeHalo &halo)
{
  for (std::size_t s = 0; s < total.size(); ++s)
    total[s] = normal[s] + friction[s];
  halo.add_to_bodies(total);
}

void HaloForces::settle_impulses()
{
  for (std::size_t s = 0; s < impulse.size(); ++s)
  {
    const std::size_t b = body_of[s];
    if (settled.size() <= b)
      settled.resize(b + 1);
    settled[b].add(impulse[s]);
  }
  impulse.clear();
  body_of.clear();
}

void HaloForces::start_impulses(const NodeHalo &halo)
{
  impulse.assign(halo.n_owned(), Vec{});
  body_of.clear();
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    body_of.push_back(halo.key(s).body);
}

void HaloForces::accumulate_work(const NodeHalo &halo, const double half_dt)
{
  if (impulse.size() != halo.n_owned())
    start_impulses(halo);
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    if (norm_square(normal[s]) + norm_square(friction[s]) > 0.)
    {
      const Vec v = half_dt * halo.body_velocity(s);
      contact_work.add(dot(normal[s], v));
      friction_work.add(dot(friction[s], v));
      impulse[s] += half_dt * (normal[s] + friction[s]);
    }
  pairs.accumulate(half_dt);
}

std::vector<Resultant>
HaloForces::resultants(const std::string &source,
                       const std::vector<std::pair<int, int>> &body_pairs,
                       const NodeHalo &halo, MPI_Comm communicator,
                       const bool with_own) const
{
  std::set<int> bodies;
  if (pairs.any())
    return pairs.resultants(source, communicator);
  for (const auto &[a, b] : body_pairs)
    if (a != b || with_own)
      bodies.insert({a, b});
  std::vector<ExactVectorSum> force(bodies.size()), total(bodies.size());
  std::vector<ExactVectorSum *> sums;
  std::size_t k = 0;
  for (const int b : bodies)
  {
    for (std::size_t s = 0; s < halo.n_owned(); ++s)
      if (halo.key(s).body == b)
        force[k].add(normal[s] + friction[s]);
    if (std::size_t(b) < settled.size())
      total[k] = settled[b];
    for (std::size_t s = 0; s < impulse.size(); ++s)
      if (body_of[s] == b)
        total[k].add(impulse[s]);
    sums.insert(sums.end(), {&force[k], &total[k]});
    ++k;
  }
  ExactVectorSum::reduce(sums, communicator);
  std::vector<Resultant> all;
  k = 0;
  for (const int b : bodies)
  {
    all.push_back({source, b, force[k].value(), total[k].value(), false});
    ++k;
  }
  return all;
}

void HaloForces::add_energies(EnergyLedger &ledger) const
{
  ledger.contact.subtract(contact_work);
  ledger.friction.subtract(friction_work);
}

void HaloForces::add_measures(Measures &measures, MPI_Comm communicator) const
{
  ExactSum work[2] = {contact_work, friction_work};
  ExactSum::reduce({&work[0], &work[1]}, communicator);
  measures.push_back({"contact energy", "J", -work[0].value()});
  measures.push_back({"friction energy", "J", -work[1].value()});
}

void HaloForces::visit_state(StateVisitor &visitor, const NodeHalo &halo,
                             const StateItems &slots)
{
  visitor.visit_sum("contact work", contact_work);
  visitor.visit_sum("friction work", friction_work);
  // Half of their work along the next step is still to be counted.
  visitor.visit_items("normal force", normal, slots);
  visitor.visit_items("friction force", friction, slots);
  if (impulse.size() != halo.n_owned())
    start_impulses(halo);
  visitor.visit_items("impulse", impulse, slots);
  settled.resize(halo.n_bodies());
  visitor.visit_sums("settled impulse", settled);
  pairs.visit_state(visitor);
}
} // namespace sabot
