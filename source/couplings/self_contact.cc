// Contact between single particles that came loose.
#include "sabot/couplings/self_contact.h"

#include "sabot/couplings/contact_search.h"
#include "sabot/couplings/mirror_images.h"
#include "sabot/couplings/node_table.h"
#include "sabot/kernels/sorted_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sabot
{
namespace
{
/** Of particles of one continuum of crumbled metal, over the spacing: seldom
    reached in dense disorder, where neighbors are 0.7 spacings apart and more.
 */
constexpr double core_distance = 0.5;

/** Numbers of the items near each of some of them, in no order. */
class NearItems
{
public:
  /** Those at most @p reach [m] away, and maybe some by round-off farther;
      @p asks(item): whether its own are wanted. */
  template <typename Asks>
  NearItems(const std::vector<DebrisImages::Item> &items, const double reach,
            const Asks &asks)
  {
    constexpr double round_off = 1. + 1e-9;
    std::vector<Row> all(items.size());
    SortedPoints(
        items.size(), [&](const std::size_t k) { return items[k].x; },
        round_off * reach)
        .for_each([&](const std::uint32_t k) { return asks(items[k]); },
                  [&](const std::uint32_t k, const std::uint32_t *const near,
                      const std::size_t n)
                  {
                    all[k] = {numbers.size(), n};
                    numbers.insert(numbers.end(), near, near + n);
                  });
    for (std::size_t k = 0; k < items.size(); ++k)
      if (asks(items[k]))
        rows.push_back(all[k]);
  }
  struct Range
  {
    const std::uint32_t *first, *last;
    const std::uint32_t *begin() const { return first; }
    const std::uint32_t *end() const { return last; }
  };
  /** Of the one that asks as the @p number-th. */
  Range of(const std::size_t number) const
  {
    const std::uint32_t *const first = numbers.data() + rows[number].start;
    return {first, first + rows[number].n};
  }

private:
  struct Row
  {
    std::size_t start = 0, n = 0;
  };
  std::vector<Row> rows;
  std::vector<std::uint32_t> numbers;
};
} // namespace

SelfContact::SelfContact(const std::string &name,
                         const std::vector<Body *> &bodies,
                         const std::vector<std::pair<int, int>> &pairs,
                         const SelfContactOptions &options,
                         MPI_Comm communicator)
    : Coupling(name), bodies(bodies), body_pairs(pairs), options(options),
      communicator(communicator), images(bodies)
{
  forces.pairs = PairForces(body_pairs, bodies);
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
  age.traveled +=
      age.closing_speed.largest(bodies, body_pairs, communicator) * dt;
  // Newly failed particles are met at the next search; those that come close
  // by then were bonded until the last kernel update.
  if (age.traveled > skin || age.have_changed(bodies))
    search();
}

SelfContact::Pair SelfContact::make_pair(const NodeKey &a, const NodeKey &b,
                                         const std::uint64_t image,
                                         const double distance,
                                         const double reach,
                                         const DebrisView &of_a,
                                         const DebrisView &of_b) const
{
  const double h = std::min(of_a.spacing, of_b.spacing);
  Pair pair{};
  pair.first = std::min(a, b);
  pair.second = std::max(a, b);
  pair.image = image;
  pair.largest_distance = reach * h;
  pair.distance = std::min(pair.largest_distance, distance);
  pair.stiffness = options.stiffness_scale * h *
                   std::min(of_a.bulk_modulus, of_b.bulk_modulus);
  pair.area = h * h;
  pair.largest_friction = pair.area * options.shear_strength.value();
  return pair;
}

bool SelfContact::comes_before(const Pair &p, const Pair &q)
{
  return !(p.first == q.first)     ? p.first < q.first
         : !(p.second == q.second) ? p.second < q.second
                                   : p.image < q.image;
}

void SelfContact::find_pairs()
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const auto is_mine = [&](const NodeKey &key)
  { return bodies[key.body]->node_owner[key.node] == rank; };
  Debris debris(bodies, body_pairs);
  const double reach = options.contact_distance * debris.largest_spacing + skin;
  debris.gather_near(images, reach, communicator);
  n_loose = debris.n_all;
  const std::vector<LooseParticle> &near = debris.near;
  const std::vector<DebrisImages::Item> items = images.with_images(near, reach);
  const NearItems near_items(items, reach,
                             [&](const DebrisImages::Item &item) {
                               return item.image == 0 &&
                                      is_mine(near[item.number].key);
                             });
  std::vector<Pair> found;
  found.reserve(pairs.size() + pairs.size() / 8);
  std::size_t number = 0;
  for (const LooseParticle &from : debris.mine)
  {
    const NodeKey &a = from.key;
    const std::size_t first_found = found.size();
    const std::uint64_t images_of_a = images.near(a.body, from.x, reach);
    for (const std::uint32_t k : near_items.of(number++))
    {
      const DebrisImages::Item &other = items[k];
      const double square = norm_square(other.x - from.x);
      if (square > reach * reach)
        continue;
      const LooseParticle &to = near[other.number];
      const NodeKey &b = to.key;
      // A pair owned here twice is kept once.
      if (b < a && is_mine(b))
        continue;
      if (!debris.may_meet(a, b) || (a == b && other.image == 0) ||
          (other.image & ~images_of_a))
        continue;
      const double distance = std::sqrt(square);
      const ParticleView &view = *bodies[a.body]->particles();
      const bool are_continuous =
          a.body == b.body && from.is_continuous && to.is_continuous;
      if (a.body == b.body && !are_continuous &&
          (other.image == 0 ? view.are_bonded(from.local, b.node)
                            : view.are_bonded(from.local, b.node, other.x)))
        continue;
      const int n_planes = images.n_common_planes(from, to);
      if (are_continuous && n_planes > 1)
        continue; // pieces in a file buckle, though planes keep them in line
      // Where their continuum bears the pressure, they only must not pass
      // through each other where it is loose.
      const double core =
          are_continuous ? core_distance : options.contact_distance;
      found.push_back(make_pair(a, b, other.image, distance, core,
                                debris.views[a.body], debris.views[b.body]));
      const double share = std::ldexp(1., -n_planes);
      found.back().stiffness *= share;
      found.back().area *= share;
      found.back().largest_friction *= share;
    }
    std::sort(found.begin() + first_found, found.end(), comes_before);
  }
  // In order already, but for pairs whose first one another rank owns.
  if (!std::is_sorted(found.begin(), found.end(), comes_before))
    std::sort(found.begin(), found.end(), comes_before);
  auto old = pairs.begin();
  for (Pair &pair : found)
  {
    while (old != pairs.end() && comes_before(*old, pair))
      ++old;
    if (old != pairs.end() && !comes_before(pair, *old))
      pair.distance = std::min(old->distance, pair.largest_distance);
  }
  pairs = std::move(found);
}

void SelfContact::search()
{
  age.traveled = 0.;
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
  NodeTable slot_of(bodies);
  for (const Pair &pair : pairs)
    slot_of[pair.first] = slot_of[pair.second] = 0;
  halo.build(bodies, slot_of.keys(), communicator);
  slot_of.take_slots(halo);
  for (Pair &pair : pairs)
  {
    pair.slot[0] = slot_of[pair.first];
    pair.slot[1] = slot_of[pair.second];
  }
  wake.assign(pairs.size(), 0.);
  softening.resize(halo.size());
  forces.resize(halo.size());
}

void SelfContact::soften(const double dt)
{
  // The stiffness of all that touches a particle bounds its frequency; that of
  // particles owned here is complete.
  std::fill(softening.begin(), softening.end(), 0.);
  touching.clear();
  for (std::size_t p = 0; p < pairs.size(); ++p)
  {
    if (age.traveled < wake[p])
      continue; // still apart
    const Pair &pair = pairs[p];
    const std::size_t a = pair.slot[0], b = pair.slot[1];
    const double square = norm_square(
        images.mirrored(pair.image, halo.position[b]) - halo.position[a]);
    if (square >= pair.distance * pair.distance)
    {
      wake[p] = age.traveled + 0.99 * (std::sqrt(square) - pair.distance);
      continue;
    }
    touching.push_back(p);
    softening[a] += pair.stiffness;
    if (b != a)
      softening[b] += pair.stiffness;
  }
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
  soften(std::max(dt, kept_step));
  kept_step = 0.;
  points.clear();
  for (const std::size_t number : touching)
  {
    const Pair &pair = pairs[number];
    const std::size_t a = pair.slot[0], b = pair.slot[1];
    Vec offset =
        images.mirrored(pair.image, halo.position[b]) - halo.position[a];
    if (a == b)
      offset = images.to_own_image(pair.image, offset);
    const double distance = norm(offset);
    if (distance >= pair.distance || distance == 0.)
      continue;
    ContactPoint on_b;
    on_b.item = number;
    on_b.normal = (1. / distance) * offset;
    on_b.velocity = flipped(halo.velocity[b], images.turned_axes(pair.image)) -
                    halo.velocity[a];
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
  const Pair &pair = pairs[on_second.item];
  const std::size_t a = pair.slot[0], b = pair.slot[1];
  const Vec normal = on_second.pressing * on_second.normal,
            friction = on_second.friction;
  forces.normal[a] -= normal;
  forces.friction[a] -= friction;
  if (forces.pairs.any())
    forces.pairs.add(halo, a, b, -1. * (normal + friction));
  if (pair.first == pair.second)
    return; // the other is no node of the model
  const unsigned int turned = images.turned_axes(pair.image);
  forces.normal[b] += flipped(normal, turned);
  forces.friction[b] += flipped(friction, turned);
  if (forces.pairs.any())
    forces.pairs.add(halo, b, a, flipped(normal + friction, turned));
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
  int rank;
  MPI_Comm_rank(communicator, &rank);
  age.visit_state(visitor);
  visitor.visit_value("loose particles", n_loose);
  // A pair knows at which distance it was first met.
  const auto is_mine = [&](const NodeKey &key)
  { return bodies[key.body]->node_owner[key.node] == rank; };
  std::vector<Pair> saved;
  for (const Pair &pair : pairs)
    if (is_mine(pair.first))
      saved.push_back(pair);
  visitor.visit_all("pairs", saved);
  if (visitor.is_restoring())
  {
    pairs.clear();
    for (const Pair &pair : saved)
      if (is_mine(pair.first) || is_mine(pair.second))
        pairs.push_back(pair);
    std::sort(pairs.begin(), pairs.end(), comes_before);
    build_halo();
  }
  const std::vector<GlobalIndex> keys = halo.numbers();
  const StateItems slots = {visitor.section + "/slots", keys.data(),
                            halo.n_owned(), halo.size()};
  visitor.visit_keys(slots);
  forces.visit_state(visitor, halo, slots);
}
} // namespace sabot
