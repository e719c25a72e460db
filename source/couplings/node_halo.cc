// Nodes of several bodies that a rank needs for a coupling, wherever they are
// owned: numbering, exchange of motion, return of forces.

#include "sabot/couplings/node_halo.h"

#include <algorithm>
#include <stdexcept>

namespace sabot
{
namespace
{
std::size_t owned_index(const Body &body, const GlobalIndex node)
{
  const auto &ids = body.nodes().global_id;
  return std::lower_bound(ids.begin(), ids.begin() + body.nodes().n_owned,
                          node) -
         ids.begin();
}
} // namespace

void NodeHalo::build(const std::vector<Body *> &bodies,
                     std::vector<NodeKey> keys, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  all_bodies = bodies;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto owner = [&](const NodeKey &k)
  { return bodies[k.body]->node_owner[k.node]; };
  std::stable_partition(keys.begin(), keys.end(),
                        [&](const NodeKey &k) { return owner(k) == rank; });
  key_of_slot = keys;
  owned_body.clear();
  owned_local.clear();
  std::vector<int> ghost_owner;
  std::vector<GlobalIndex> ghost_key;
  const GlobalIndex n_bodies = bodies.size();
  for (const NodeKey &k : keys)
    if (owner(k) == rank)
    {
      owned_body.push_back(k.body);
      owned_local.push_back(owned_index(*bodies[k.body], k.node));
    }
    else
    {
      ghost_owner.push_back(owner(k));
      ghost_key.push_back(k.node * n_bodies + k.body);
    }

  // A node that another rank asks for gets a slot here, too.
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks > 1)
  {
    const std::size_t n_before = owned_body.size();
    std::vector<NodeKey> asked;
    GhostExchange(communicator, 0, ghost_owner, ghost_key,
                  [&](const GlobalIndex key)
                  {
                    asked.push_back({std::int32_t(key % n_bodies), 0,
                                     GlobalIndex(key / n_bodies)});
                    return std::size_t(0);
                  });
    bool missing = false;
    for (const NodeKey &k : asked)
      missing =
          missing || !std::binary_search(key_of_slot.begin(),
                                         key_of_slot.begin() + n_before, k);
    if (missing)
    {
      std::vector<NodeKey> owned(key_of_slot.begin(),
                                 key_of_slot.begin() + n_before);
      owned.insert(owned.end(), asked.begin(), asked.end());
      std::sort(owned.begin(), owned.end());
      owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
      std::vector<NodeKey> others(key_of_slot.begin() + n_before,
                                  key_of_slot.end());
      key_of_slot = owned;
      key_of_slot.insert(key_of_slot.end(), others.begin(), others.end());
      owned_body.clear();
      owned_local.clear();
      for (const NodeKey &k : owned)
      {
        owned_body.push_back(k.body);
        owned_local.push_back(owned_index(*bodies[k.body], k.node));
      }
    }
  }
  const std::size_t n = owned_body.size();
  exchange =
      GhostExchange(communicator, n, ghost_owner, ghost_key,
                    [&](const GlobalIndex key)
                    {
                      const NodeKey k{std::int32_t(key % n_bodies), 0,
                                      GlobalIndex(key / n_bodies)};
                      return std::lower_bound(key_of_slot.begin(),
                                              key_of_slot.begin() + n, k) -
                             key_of_slot.begin();
                    });
  position.resize(size());
  velocity.resize(size());
  inertia.resize(size());
}

void NodeHalo::update()
{
  for (std::size_t s = 0; s < n_owned(); ++s)
  {
    const NodalState &nodes = all_bodies[owned_body[s]]->nodes();
    const std::size_t i = owned_local[s];
    position[s] = nodes.position[i];
    velocity[s] = nodes.velocity[i];
    // A tied follower moves with its leaders; its own mass is a safe (low)
    // measure of what resists.
    inertia[s] =
        nodes.inertia[i] > 0. ? nodes.inertia[i] : nodes.lumped_mass[i];
  }
  exchange.update(position.data());
  exchange.update(velocity.data());
  exchange.update(inertia.data());
}

void NodeHalo::find_flow_stress(std::vector<double> &of_slots) const
{
  of_slots.resize(size());
  for (std::size_t s = 0, end; s < n_owned(); s = end)
  {
    // Slots are sorted by body.
    std::vector<std::size_t> nodes;
    for (end = s; end < n_owned() && owned_body[end] == owned_body[s]; ++end)
      nodes.push_back(owned_local[end]);
    const auto found = all_bodies[owned_body[s]]->flow_stress(nodes);
    std::copy(found.begin(), found.end(), of_slots.begin() + s);
  }
  exchange.update(of_slots.data());
}

std::size_t NodeHalo::slot(const NodeKey &key) const
{
  const auto middle = key_of_slot.begin() + n_owned();
  auto found = std::lower_bound(key_of_slot.begin(), middle, key);
  if (found == middle || !(*found == key))
    found = std::lower_bound(middle, key_of_slot.end(), key);
  if (found == key_of_slot.end() || !(*found == key))
    throw std::logic_error("node halo: a node was not asked for");
  return found - key_of_slot.begin();
}

void NodeHalo::add_to_bodies(const AlignedVector<Vec> &force) const
{
  for (std::size_t s = 0; s < n_owned(); ++s)
    all_bodies[owned_body[s]]->nodes().force[owned_local[s]] += force[s];
}
} // namespace sabot
