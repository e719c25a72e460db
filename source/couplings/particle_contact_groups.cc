// Groups of a contact between bodies of particles: how they are found and kept.
#include "sabot/base/send_some.h"
#include "sabot/couplings/particle_contact.h"

#include <algorithm>

namespace sabot
{
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
  const ParticleSearch found(bodies, pairs, way.skin, communicator);
  way.allowance = std::max(way.skin, found.gap());
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
  find_shares();
}

void ParticleContact::find_shares()
{
  share.assign(halo.size(), 1.);
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    if (symmetry_planes[b].empty())
      continue;
    const ContactSurface its = bodies[b]->contact_surface();
    for (std::size_t s = 0; s < halo.n_owned(); ++s)
      if (halo.key(s).body == std::int32_t(b))
        share[s] = its.node_share[halo.local(s)];
  }
  halo.update_ghosts(share.data());
}
} // namespace sabot
