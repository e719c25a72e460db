#include "sabot/couplings/self_contact.h"

#include "sabot/couplings/contact_search.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sabot
{
namespace
{
struct Loose
{
  NodeKey key;
  std::size_t local; // on its owner
  Vec x;
};
} // namespace

SelfContact::SelfContact(const std::string &name,
                         const std::vector<Body *> &bodies,
                         const SelfContactOptions &options,
                         MPI_Comm communicator)
    : Coupling(name), bodies(bodies), options(options),
      communicator(communicator)
{
}

void SelfContact::initialize()
{
  skin = 1e300;
  for (const Body *body : bodies)
    if (body->debris().spacing > 0.)
      skin = std::min(skin, 0.4 * body->debris().spacing);
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b)
      if (bodies[a]->debris().spacing > 0. && bodies[b]->debris().spacing > 0.)
        body_pairs.emplace_back(a, b);
  search();
}

void SelfContact::update_search(const unsigned int, const double dt)
{
  travelled += largest_closing_speed(bodies, body_pairs, communicator) * dt;
  // Newly failed particles are met at the next search; those that come close
  // by then were bonded until the last kernel update.
  if (travelled > skin)
    search();
}

void SelfContact::search()
{
  travelled = 0.;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<Loose> mine;
  std::vector<DebrisView> views;
  double largest_spacing = 0.;
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    views.push_back(bodies[b]->debris());
    largest_spacing = std::max(largest_spacing, views.back().spacing);
    for (const std::size_t i : views.back().nodes)
      mine.push_back({{std::int32_t(b), 0, bodies[b]->nodes().global_id[i]},
                      i,
                      bodies[b]->nodes().position[i]});
  }
  const std::vector<Loose> all = gather_all(mine, communicator);
  n_loose = all.size();

  const double reach = options.contact_distance * largest_spacing + skin;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> buckets;
  const auto key = [&](const Vec x, const int dx, const int dy, const int dz)
  {
    constexpr std::int64_t mask = (1 << 21) - 1;
    const std::int64_t i = std::floor(x[0] / reach),
                       j = std::floor(x[1] / reach),
                       k = std::floor(x[2] / reach);
    return ((i + dx) & mask) << 42 | ((j + dy) & mask) << 21 |
           ((k + dz) & mask);
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    buckets[key(all[i].x, 0, 0, 0)].push_back(i);

  std::vector<Pair> found;
  for (std::size_t i = 0; i < mine.size(); ++i)
  {
    const NodeKey &a = mine[i].key;
    const std::size_t a_local = mine[i].local;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
        {
          const auto bucket = buckets.find(key(mine[i].x, dx, dy, dz));
          if (bucket == buckets.end())
            continue;
          for (const std::size_t j : bucket->second)
          {
            const NodeKey &b = all[j].key;
            const double distance = norm(all[j].x - mine[i].x);
            if (a == b || distance > reach)
              continue;
            // A pair owned here twice is kept once.
            if (b < a && bodies[b.body]->node_owner[b.node] == rank)
              continue;
            if (a.body == b.body && bodies[a.body]->are_bonded(a_local, b.node))
              continue;
            const double h = std::min(views[a.body].spacing,
                                      views[b.body].spacing),
                         E = std::min(views[a.body].young_modulus,
                                      views[b.body].young_modulus);
            Pair pair;
            pair.first = std::min(a, b);
            pair.second = std::max(a, b);
            pair.distance = std::min(options.contact_distance * h, distance);
            pair.stiffness = options.stiffness_scale * E * h;
            found.push_back(pair);
          }
        }
  }
  const auto before = [](const Pair &p, const Pair &q)
  { return p.first == q.first ? p.second < q.second : p.first < q.first; };
  std::sort(found.begin(), found.end(), before);
  for (Pair &pair : found)
  {
    const auto old = std::lower_bound(pairs.begin(), pairs.end(), pair, before);
    if (old != pairs.end() && old->first == pair.first &&
        old->second == pair.second)
      pair.distance = old->distance;
  }
  pairs = std::move(found);
  build_halo();
}

void SelfContact::build_halo()
{
  std::vector<NodeKey> needed;
  for (const Pair &pair : pairs)
  {
    needed.push_back(pair.first);
    needed.push_back(pair.second);
  }
  halo.build(bodies, needed, communicator);
  for (Pair &pair : pairs)
  {
    pair.slot[0] = halo.slot(pair.first);
    pair.slot[1] = halo.slot(pair.second);
  }
  normal_force.assign(halo.size(), Vec{});
  friction_force.assign(halo.size(), Vec{});
  total_force.assign(halo.size(), Vec{});
}

void SelfContact::add_forces(const double dt)
{
  halo.update();
  std::fill(normal_force.begin(), normal_force.end(), Vec{});
  std::fill(friction_force.begin(), friction_force.end(), Vec{});
  if (dt <= 0.)
    return;
  for (const Pair &pair : pairs)
  {
    const std::size_t a = pair.slot[0], b = pair.slot[1];
    const Vec offset = halo.position[b] - halo.position[a];
    const double distance = norm(offset);
    if (distance >= pair.distance || distance == 0.)
      continue;
    const Vec n = (1. / distance) * offset;
    const Vec v = halo.velocity[b] - halo.velocity[a];
    const double reduced_mass =
        1. / (1. / halo.inertia[a] + 1. / halo.inertia[b]);
    const double k = std::min(pair.stiffness, options.stability_fraction *
                                                  reduced_mass / (dt * dt));
    const double rate = dot(v, n);
    const double pressing =
        k * (pair.distance - distance) + 2. * options.damping_fraction *
                                             std::sqrt(k * reduced_mass) *
                                             std::max(0., -rate);
    const Vec sliding = v - rate * n;
    const double speed = norm(sliding);
    const double drag = speed > 0. ? std::min(options.friction * pressing,
                                              0.5 * reduced_mass * speed / dt) /
                                         speed
                                   : 0.;
    normal_force[a] -= pressing * n;
    normal_force[b] += pressing * n;
    friction_force[a] += drag * sliding;
    friction_force[b] -= drag * sliding;
  }
  for (std::size_t s = 0; s < halo.size(); ++s)
    total_force[s] = normal_force[s] + friction_force[s];
  halo.add_to_bodies(total_force);
}

void SelfContact::accumulate_work(const double half_dt)
{
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    if (norm_square(normal_force[s]) > 0.)
    {
      const Vec v = half_dt * halo.body_velocity(s);
      contact_work.add(dot(normal_force[s], v));
      friction_work.add(dot(friction_force[s], v));
    }
}

void SelfContact::add_energies(EnergyLedger &ledger) const
{
  ledger.contact.subtract(contact_work);
  ledger.friction.subtract(friction_work);
}

Measures SelfContact::measure() const
{
  ExactSum work[2] = {contact_work, friction_work};
  ExactSum::reduce({&work[0], &work[1]}, communicator);
  return {{"loose particles", "1", double(n_loose)},
          {"contact energy", "J", -work[0].value()},
          {"friction energy", "J", -work[1].value()}};
}

void SelfContact::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("contact work", contact_work);
  visitor.visit_value("friction work", friction_work);
  visitor.visit_value("travelled", travelled);
  visitor.visit_value("loose particles", n_loose);
  // A pair knows at which distance it was first met.
  visitor.visit_resized("pairs", pairs);
  if (visitor.is_restoring())
    build_halo();
  // Half of their work along the next step is still to be counted.
  visitor.visit_array("normal force", normal_force);
  visitor.visit_array("friction force", friction_force);
}
} // namespace sabot
