// Contact between bodies of particles.
#include "sabot/couplings/particle_contact.h"

#include "sabot/base/send_some.h"
#include "sabot/couplings/contact_search.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
ParticleContact::ParticleContact(const std::string &name,
                                 const std::vector<Body *> &bodies,
                                 const std::vector<std::pair<int, int>> &pairs,
                                 const ContactOptions &options,
                                 MPI_Comm communicator)
    : Coupling(name), bodies(bodies), pairs(pairs), options(options),
      communicator(communicator), shared_work(pairs, communicator)
{
  forces.pairs = PairForces(pairs, bodies);
}

void ParticleContact::initialize()
{
  skin = 1e300;
  symmetry_planes.resize(bodies.size());
  for (const auto &[a, b] : pairs)
    for (const int body : {a, b})
    {
      const ContactSurface its = bodies[body]->contact_surface();
      symmetry_planes[body] = its.symmetry_planes;
      skin = std::min(skin, 0.4 * its.spacing);
    }
  search();
  update_halo();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const Standing at = locate(groups[g], slots[g]);
    if (at.fade > 0.)
      over_spacing.initial =
          std::max(over_spacing.initial, -at.gap / groups[g].spacing);
  }
  MPI_Allreduce(MPI_IN_PLACE, &over_spacing.initial, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
}

void ParticleContact::update_search(const unsigned int, const double dt)
{
  age.traveled += age.closing_speed.largest(bodies, pairs, communicator) * dt;
  // Bodies that grow have new particles at once.
  if (age.traveled > allowance || age.have_changed(bodies))
    search();
}

ParticleContact::Group ParticleContact::make_group(
    const SearchedParticle &node, const int other, const std::int64_t n_members,
    const ContactSurface &mine, const ContactSurface &its) const
{
  Group group{};
  group.node = node.key;
  group.other = other;
  group.is_sound = node.is_on_surface;
  group.n_members = n_members;
  group.spacing = mine.spacing;
  group.its_spacing = its.spacing;
  group.stiffness = node.share * options.stiffness_scale *
                    std::min(mine.bulk_modulus, its.bulk_modulus) *
                    mine.spacing;
  // Where both sides meet surfaces, each carries half of the shear.
  group.area =
      node.share * mine.spacing * mine.spacing / (node.is_on_surface ? 2. : 1.);
  const auto old = std::lower_bound(groups.begin(), groups.end(), group);
  if (old != groups.end() && !(group < *old))
    group.memory = old->memory;
  return group;
}

void ParticleContact::search()
{
  age.traveled = 0.;
  const ParticleSearch found(bodies, pairs, skin, communicator);
  allowance = std::max(skin, found.gap());
  // Owners look for what their nodes may touch.
  std::vector<Group> my_groups;
  std::vector<Member> my_members;
  for (const SearchedParticle &node : found.mine())
    for (const auto &[a, b] : pairs)
    {
      if (!node.is_open || (node.key.body != a && node.key.body != b))
        continue;
      const int other = node.key.body == a ? b : a;
      const std::size_t before = my_members.size();
      found.near(node, other, my_members);
      if (my_members.size() > before)
        my_groups.push_back(make_group(node, other, my_members.size() - before,
                                       found.surface(node.key.body),
                                       found.surface(other)));
    }
  tell_owners(my_groups, my_members);
  build_halo();
  if (options.shear_strength.needs_flow_stress())
    halo.find_flow_stress(flow_stress);
}

void ParticleContact::tell_owners(const std::vector<Group> &my_groups,
                                  const std::vector<Member> &my_members)
{
  int n_ranks, rank;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &rank);
  std::vector<std::vector<Group>> to_rank(n_ranks);
  std::vector<std::vector<Member>> its(n_ranks);
  auto begin = my_members.begin();
  for (const Group &group : my_groups)
  {
    const auto end = begin + group.n_members;
    std::vector<int> owners = {rank};
    for (auto m = begin; m != end; ++m)
      owners.push_back(bodies[m->key.body]->node_owner[m->key.node]);
    std::sort(owners.begin(), owners.end());
    owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
    for (const int owner : owners)
    {
      to_rank[owner].push_back(group);
      its[owner].insert(its[owner].end(), begin, end);
    }
    begin = end;
  }
  keep_relevant(send_some(to_rank, communicator), send_some(its, communicator));
}

void ParticleContact::keep_relevant(const std::vector<Group> &all,
                                    const std::vector<Member> &all_members)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<std::size_t> first(all.size() + 1, 0), order(all.size());
  for (std::size_t g = 0; g < all.size(); ++g)
  {
    first[g + 1] = first[g] + all[g].n_members;
    order[g] = g;
  }
  std::sort(order.begin(), order.end(),
            [&](const std::size_t a, const std::size_t b)
            { return all[a] < all[b]; });
  const auto owned = [&](const NodeKey &key)
  { return bodies[key.body]->node_owner[key.node] == rank; };
  const auto owned_member = [&](const Member &member)
  { return owned(member.key); };
  groups.clear();
  members.clear();
  for (const std::size_t g : order)
  {
    const auto begin = all_members.begin() + first[g],
               end = all_members.begin() + first[g + 1];
    if (!owned(all[g].node) && std::none_of(begin, end, owned_member))
      continue;
    groups.push_back(all[g]);
    members.insert(members.end(), begin, end);
  }
}

double ParticleContact::largest_friction(const Group &group,
                                         const Slots &at) const
{
  if (!options.shear_strength.needs_flow_stress())
    return options.shear_strength.value() * group.area;
  double its = 0.;
  for (const NearParticle &p : near)
    its += p.weight * flow_stress[p.slot];
  return ShearStrength::of_metals(flow_stress[at.node], its) * group.area;
}

void ParticleContact::build_halo()
{
  std::vector<NodeKey> needed;
  for (const Member &member : members)
    needed.push_back(member.key);
  for (const Group &group : groups)
    needed.push_back(group.node);
  halo.build(bodies, needed, communicator);
  is_on_surface.assign(halo.size(), 0);
  slots.clear();
  member_slots.clear();
  for (const Member &member : members)
  {
    member_slots.push_back(halo.slot(member.key));
    is_on_surface[member_slots.back()] |= member.is_on_surface;
  }
  std::size_t first = 0;
  for (const Group &group : groups)
  {
    slots.push_back({halo.slot(group.node), first, first + group.n_members});
    is_on_surface[slots.back().node] |= group.is_sound;
    first += group.n_members;
  }
  surface.assign(halo.size(), SurfacePoint());
  volume.resize(halo.size());
  forces.resize(halo.size());
}

void ParticleContact::update_halo()
{
  halo.update();
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
  {
    const ParticleView &body = *halo.body(s).particles();
    if (is_on_surface[s])
      surface[s] = body.surface_point(halo.local(s));
    volume[s] = body.volume_point(halo.local(s));
  }
  halo.update_ghosts(surface.data());
  halo.update_ghosts(volume.data());
}

Standing ParticleContact::locate(const Group &group, const Slots &at)
{
  const Vec x = halo.position[at.node];
  near.clear();
  if (group.is_sound)
  {
    for (std::size_t m = at.first_member; m < at.last_member; ++m)
      near.push_back(
          {member_slots[m], 0, x - halo.position[member_slots[m]], 0.});
    const Standing standing = stand_on_surface(
        {surface[at.node], group.memory.side, group.memory.depth > 0.}, near,
        surface);
    if (standing.fade > 0.)
      return standing;
    near.clear();
  }
  images.find(symmetry_planes[group.other], x,
              2. * ParticleSearch::reach * group.its_spacing);
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
    for (unsigned int image = 0; image < images.size(); ++image)
      near.push_back({member_slots[m], images.axes(image),
                      x - images(halo.position[member_slots[m]], image), 0.});
  return stand_in_volume(near, volume);
}

void ParticleContact::find_motion(const Slots &at, ContactPoint &point) const
{
  // A particle and its images move as one.
  double compliance = 1. / halo.inertia[at.node];
  const AlignedVector<Vec> &start = halo.start_velocity();
  Vec v = halo.velocity[at.node], first = start[at.node];
  for (std::size_t p = 0; p < near.size();)
  {
    const std::size_t j = near[p].slot;
    Vec part = {};
    for (; p < near.size() && near[p].slot == j; ++p)
    {
      part += near[p].weight * flipped(point.normal, near[p].turned);
      v -= near[p].weight * flipped(halo.velocity[j], near[p].turned);
      first -= near[p].weight * flipped(start[j], near[p].turned);
    }
    compliance += norm_square(part) / halo.inertia[j];
  }
  point.velocity = v;
  point.first_velocity = first;
  point.reduced_mass = 1. / compliance;
}

void ParticleContact::press(const std::size_t number, const double dt)
{
  Group &group = groups[number];
  const Slots &at = slots[number];
  const Standing standing = locate(group, at);
  ContactMemory &memory = group.memory;
  n_deep += standing.is_deep && at.node < halo.n_owned();
  if (standing.fade > 0.)
    memory.side = standing.normal;
  if (!is_step(dt))
  {
    if (standing.gap > -1e-6 * group.spacing)
      memory.release();
    return;
  }
  if (standing.fade <= 0. || standing.gap >= 0.)
    return memory.release();
  ContactPoint point;
  point.item = number;
  point.normal = standing.normal;
  point.fade = standing.fade;
  find_motion(at, point);
  point.depth =
      memory.effective_depth(-standing.gap, 2. * point.largest_speed() * dt);
  if (point.depth <= 0.)
    return;
  point.stiffness = options.stable_stiffness(
      group.stiffness, point.reduced_mass, points.steady_step.value);
  point.area = group.area;
  point.largest_friction = largest_friction(group, at);
  point.memory = &memory;
  point.pair = shared_work.number_of(group.node.body, group.other);
  point.is_owned = at.node < halo.n_owned();
  point.first_touched = touched.size();
  for (const NearParticle &p : near)
    if (p.weight != 0.)
      touched.push_back(p);
  point.last_touched = touched.size();
  points.add(point);
  over_spacing.largest =
      std::max(over_spacing.largest, point.depth / group.spacing);
}

void ParticleContact::push(const ContactPoint &point)
{
  const std::size_t node = slots[point.item].node;
  const Vec normal = point.normal_force(), friction = point.friction_force();
  forces.normal[node] += normal;
  forces.friction[node] += friction;
  for (std::size_t i = point.first_touched; i < point.last_touched; ++i)
  {
    const NearParticle &p = touched[i];
    forces.normal[p.slot] -= p.weight * flipped(normal, p.turned);
    forces.friction[p.slot] -= p.weight * flipped(friction, p.turned);
    if (forces.pairs.any())
    {
      const Vec part = p.weight * (normal + friction);
      forces.pairs.add(halo, node, p.slot, part);
      forces.pairs.add(halo, p.slot, node, -1. * flipped(part, p.turned));
    }
  }
}

void ParticleContact::add_forces(const double dt)
{
  update_halo();
  forces.clear();
  n_deep = 0;
  points.clear();
  touched.clear();
  points.steady_step.follow(dt);
  for (std::size_t g = 0; g < groups.size(); ++g)
    press(g, dt);
  points.find_forces(options, dt, &shared_work);
  for (const ContactPoint &point : points)
    push(point);
  forces.add_to_bodies(halo);
}

void ParticleContact::accumulate_work(const double half_dt)
{
  forces.accumulate_work(halo, half_dt);
}

void ParticleContact::add_energies(EnergyLedger &ledger) const
{
  forces.add_energies(ledger);
}

Measures ParticleContact::measure() const
{
  double penetration = over_spacing.largest;
  MPI_Allreduce(MPI_IN_PLACE, &penetration, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
  GlobalIndex deep = n_deep;
  MPI_Allreduce(MPI_IN_PLACE, &deep, 1, MPI_INT64_T, MPI_SUM, communicator);
  Measures measures = {
      {"penetration max over spacing", "1", penetration},
      {"initial penetration over spacing", "1", over_spacing.initial},
      {"nodes deep inside", "1", double(deep)}};
  forces.add_measures(measures, communicator);
  return measures;
}

void ParticleContact::visit_state(StateVisitor &visitor)
{
  age.visit_state(visitor);
  visitor.visit_value("allowance", allowance);
  visitor.visit_largest("penetration", over_spacing.largest);
  visitor.visit_value("steady step", points.steady_step.value);
  shared_work.visit_state(visitor);
  // Candidates were found where the bodies were at the last search.
  std::vector<Group> saved;
  std::vector<Member> its;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (slots[g].node < halo.n_owned())
    {
      saved.push_back(groups[g]);
      its.insert(its.end(), members.begin() + slots[g].first_member,
                 members.begin() + slots[g].last_member);
    }
  visitor.visit_all("groups", saved);
  visitor.visit_all("members", its);
  if (visitor.is_restoring())
  {
    keep_relevant(saved, its);
    build_halo();
    if (options.shear_strength.needs_flow_stress())
      flow_stress.resize(halo.size());
  }
  const std::vector<GlobalIndex> keys = halo.numbers();
  const StateItems of_slots = {visitor.section + "/slots", keys.data(),
                               halo.n_owned(), halo.size()};
  visitor.visit_keys(of_slots);
  visitor.visit_items("flow stress", flow_stress, of_slots);
  forces.visit_state(visitor, halo, of_slots);
}
} // namespace sabot
