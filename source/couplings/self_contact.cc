// Contact between single particles that came loose.
#include "sabot/couplings/self_contact.h"

#include "sabot/couplings/contact_search.h"
#include "sabot/kernels/point_buckets.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Of particles of one continuum of crumbled metal, over the spacing: seldom
    reached in dense disorder, where neighbors are 0.7 spacings apart and more.
 */
constexpr double core_distance = 0.5;

struct Loose
{
  NodeKey key;
  std::size_t local; // on its owner
  bool is_continuous;
  Vec x;
};

/** The loose particles of the bodies that take part, and who meets whom. */
struct Debris
{
  std::vector<DebrisView> views; // of bodies
  std::vector<char> meet;        // two bodies, a row each
  std::vector<Loose> mine, all;
  double largest_spacing = 0.; // [m]

  bool may_meet(const NodeKey &a, const NodeKey &b) const
  {
    return meet[a.body * views.size() + b.body];
  }
};

/** Collective. */
Debris gather_debris(const std::vector<Body *> &bodies,
                     const std::vector<std::pair<int, int>> &body_pairs,
                     MPI_Comm communicator)
{
  const std::size_t n_bodies = bodies.size();
  Debris debris;
  debris.views.resize(n_bodies);
  debris.meet.assign(n_bodies * n_bodies, 0);
  std::vector<char> used(n_bodies, 0);
  for (const auto &[a, b] : body_pairs)
  {
    debris.meet[a * n_bodies + b] = debris.meet[b * n_bodies + a] = 1;
    used[a] = used[b] = 1;
  }
  for (std::size_t b = 0; b < n_bodies; ++b)
  {
    if (!used[b])
      continue;
    const DebrisView &view = debris.views[b] = bodies[b]->particles()->debris();
    debris.largest_spacing = std::max(debris.largest_spacing, view.spacing);
    const NodalState &nodes = bodies[b]->nodes();
    for (std::size_t k = 0; k < view.nodes.size(); ++k)
    {
      const std::size_t i = view.nodes[k];
      debris.mine.push_back(
          {{std::int32_t(b), 0, nodes.global_id[i]},
           i,
           !view.is_continuous.empty() && view.is_continuous[k],
           nodes.position[i]});
    }
  }
  debris.all = gather_all(debris.mine, communicator);
  return debris;
}
} // namespace

SelfContact::SelfContact(const std::string &name,
                         const std::vector<Body *> &bodies,
                         const std::vector<std::pair<int, int>> &pairs,
                         const SelfContactOptions &options,
                         MPI_Comm communicator)
    : Coupling(name), bodies(bodies), body_pairs(pairs), options(options),
      communicator(communicator)
{
}

std::string SelfContact::kind() const
{
  for (const auto &[a, b] : body_pairs)
    if (a == b)
      return "self-contact";
  return "contact";
}

void SelfContact::initialize()
{
  skin = 1e300;
  for (const auto &[a, b] : body_pairs)
    for (const int body : {a, b})
      skin = std::min(skin, 0.4 * bodies[body]->particles()->debris().spacing);
  search();
}

void SelfContact::update_search(const unsigned int, const double dt)
{
  traveled += largest_closing_speed(bodies, body_pairs, communicator) * dt;
  // Newly failed particles are met at the next search; those that come close
  // by then were bonded until the last kernel update.
  if (traveled > skin)
    search();
}

SelfContact::Pair SelfContact::make_pair(const NodeKey &a, const NodeKey &b,
                                         const double distance,
                                         const double reach,
                                         const DebrisView &of_a,
                                         const DebrisView &of_b) const
{
  const double h = std::min(of_a.spacing, of_b.spacing);
  Pair pair{};
  pair.first = std::min(a, b);
  pair.second = std::max(a, b);
  pair.largest_distance = reach * h;
  pair.distance = std::min(pair.largest_distance, distance);
  pair.stiffness = options.stiffness_scale * h *
                   std::min(of_a.bulk_modulus, of_b.bulk_modulus);
  pair.area = h * h;
  pair.largest_friction = pair.area * options.shear_strength.value();
  return pair;
}

void SelfContact::find_pairs()
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const Debris debris = gather_debris(bodies, body_pairs, communicator);
  const std::vector<Loose> &all = debris.all;
  n_loose = all.size();
  const double reach = options.contact_distance * debris.largest_spacing + skin;
  PointBuckets buckets(reach);
  for (std::size_t i = 0; i < all.size(); ++i)
    buckets.add(all[i].x, i);
  std::vector<Pair> found;
  for (const Loose &from : debris.mine)
  {
    const NodeKey &a = from.key;
    buckets.for_near(
        from.x,
        [&](const std::size_t j)
        {
          const NodeKey &b = all[j].key;
          const double distance = norm(all[j].x - from.x);
          if (a == b || distance > reach || !debris.may_meet(a, b))
            return;
          // A pair owned here twice is kept once.
          if (b < a && bodies[b.body]->node_owner[b.node] == rank)
            return;
          if (a.body == b.body &&
              bodies[a.body]->particles()->are_bonded(from.local, b.node))
            return;
          // Where their continuum bears the pressure, they only must not pass
          // through each other where it is loose.
          const double core =
              a.body == b.body && from.is_continuous && all[j].is_continuous
                  ? core_distance
                  : options.contact_distance;
          found.push_back(make_pair(a, b, distance, core, debris.views[a.body],
                                    debris.views[b.body]));
        });
  }
  const auto before = [](const Pair &p, const Pair &q)
  { return p.first == q.first ? p.second < q.second : p.first < q.first; };
  std::sort(found.begin(), found.end(), before);
  for (Pair &pair : found)
  {
    const auto old = std::lower_bound(pairs.begin(), pairs.end(), pair, before);
    if (old != pairs.end() && old->first == pair.first &&
        old->second == pair.second)
      pair.distance = std::min(old->distance, pair.largest_distance);
  }
  pairs = std::move(found);
}

void SelfContact::search()
{
  traveled = 0.;
  find_pairs();
  build_halo();
  if (!options.shear_strength.needs_flow_stress())
    return;
  std::vector<double> flow_stress;
  halo.find_flow_stress(flow_stress);
  for (Pair &pair : pairs)
    pair.largest_friction =
        pair.area / std::sqrt(3.) *
        std::min(flow_stress[pair.slot[0]], flow_stress[pair.slot[1]]);
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
  softening.resize(halo.size());
  forces.resize(halo.size());
}

void SelfContact::soften(const double dt)
{
  // The stiffness of all that touches a particle bounds its frequency; that of
  // particles owned here is complete.
  std::fill(softening.begin(), softening.end(), 0.);
  for (const Pair &pair : pairs)
    if (norm_square(halo.position[pair.slot[1]] - halo.position[pair.slot[0]]) <
        pair.distance * pair.distance)
      for (const std::size_t s : pair.slot)
        softening[s] += pair.stiffness;
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    softening[s] =
        std::min(1., 0.5 * options.stability_fraction * halo.inertia[s] /
                         (dt * dt * std::max(softening[s], 1e-300)));
  halo.update_ghosts(softening.data());
}

void SelfContact::add_forces(const double dt)
{
  halo.update();
  forces.clear();
  if (!is_step(dt))
    return;
  soften(dt);
  points.clear();
  for (std::size_t number = 0; number < pairs.size(); ++number)
  {
    const Pair &pair = pairs[number];
    const std::size_t a = pair.slot[0], b = pair.slot[1];
    const Vec offset = halo.position[b] - halo.position[a];
    const double distance = norm(offset);
    if (distance >= pair.distance || distance == 0.)
      continue;
    ContactPoint on_b;
    on_b.item = number;
    on_b.normal = (1. / distance) * offset;
    on_b.velocity = halo.velocity[b] - halo.velocity[a];
    on_b.depth = pair.distance - distance;
    on_b.stiffness = pair.stiffness * std::min(softening[a], softening[b]);
    on_b.reduced_mass = 1. / (1. / halo.inertia[a] + 1. / halo.inertia[b]);
    on_b.area = pair.area;
    on_b.largest_friction = pair.largest_friction;
    points.add(on_b);
  }
  points.find_forces(options, dt);
  for (const ContactPoint &point : points)
    push(point);
  forces.add_to_bodies(halo);
}

void SelfContact::push(const ContactPoint &on_second)
{
  const std::size_t a = pairs[on_second.item].slot[0],
                    b = pairs[on_second.item].slot[1];
  const Vec normal = on_second.pressing * on_second.normal,
            friction = -on_second.drag * on_second.sliding;
  forces.normal[a] -= normal;
  forces.normal[b] += normal;
  forces.friction[a] -= friction;
  forces.friction[b] += friction;
}

void SelfContact::accumulate_work(const double half_dt)
{
  forces.accumulate_work(halo, half_dt);
}

void SelfContact::add_energies(EnergyLedger &ledger) const
{
  forces.add_energies(ledger);
}

Measures SelfContact::measure() const
{
  Measures measures = {{"loose particles", "1", double(n_loose)}};
  forces.add_measures(measures, communicator);
  return measures;
}

void SelfContact::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("traveled", traveled);
  visitor.visit_value("loose particles", n_loose);
  // A pair knows at which distance it was first met.
  visitor.visit_resized("pairs", pairs);
  if (visitor.is_restoring())
    build_halo();
  forces.visit_state(visitor);
}
} // namespace sabot
