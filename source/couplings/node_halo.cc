// Copies of the motion of a few nodes of any bodies, wherever they live.
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

void NodeHalo::take_owned(const std::vector<NodeKey> &owned)
{
  owned_body.clear();
  owned_local.clear();
  for (const NodeKey &k : owned)
  {
    owned_body.push_back(k.body);
    owned_local.push_back(owned_index(*all_bodies[k.body], k.node));
  }
}

void NodeHalo::add_asked(const std::vector<NodeKey> &asked)
{
  const auto middle = key_of_slot.begin() + n_owned();
  std::vector<NodeKey> owned(key_of_slot.begin(), middle);
  const std::vector<NodeKey> others(middle, key_of_slot.end());
  owned.insert(owned.end(), asked.begin(), asked.end());
  std::sort(owned.begin(), owned.end());
  owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
  key_of_slot = owned;
  key_of_slot.insert(key_of_slot.end(), others.begin(), others.end());
  take_owned(owned);
}

void NodeHalo::build(const std::vector<Body *> &bodies,
                     std::vector<NodeKey> keys, MPI_Comm communicator)
{
  int rank, n_ranks;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  all_bodies = bodies;
  ++n_updates;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto owner = [&](const NodeKey &k)
  { return bodies[k.body]->node_owner[k.node]; };
  const auto others =
      std::stable_partition(keys.begin(), keys.end(),
                            [&](const NodeKey &k) { return owner(k) == rank; });
  key_of_slot = keys;
  take_owned({keys.begin(), others});
  // Ranks name nodes to each other by one number.
  const GlobalIndex n_bodies = bodies.size();
  const auto key_of_number = [&](const GlobalIndex number)
  {
    return NodeKey{std::int32_t(number % n_bodies), 0,
                   GlobalIndex(number / n_bodies)};
  };
  std::vector<int> ghost_owner;
  std::vector<GlobalIndex> ghost_number;
  for (auto k = others; k != keys.end(); ++k)
  {
    ghost_owner.push_back(owner(*k));
    ghost_number.push_back(k->node * n_bodies + k->body);
  }
  if (n_ranks > 1)
  {
    // A node that another rank asks for gets a slot here, too.
    std::vector<NodeKey> asked;
    GhostExchange(communicator, 0, ghost_owner, ghost_number,
                  [&](const GlobalIndex number)
                  {
                    asked.push_back(key_of_number(number));
                    return std::size_t(0);
                  });
    add_asked(asked);
  }
  exchange = GhostExchange(communicator, n_owned(), ghost_owner, ghost_number,
                           [&](const GlobalIndex number)
                           { return slot(key_of_number(number)); });
  position.resize(size());
  velocity.resize(size());
  inertia.resize(size());
}

void NodeHalo::update()
{
  ++n_updates;
  for (std::size_t s = 0; s < n_owned(); ++s)
  {
    const NodalState &nodes = all_bodies[owned_body[s]]->nodes();
    const std::size_t i = owned_local[s];
    position[s] = nodes.position[i];
    velocity[s] = nodes.velocity[i];
    // A tied follower moves with its leaders; its own mass is a safe (low)
    // measure of what resists.
    inertia[s] = nodes.is_follower(i) ? nodes.lumped_mass[i] : nodes.inertia[i];
  }
  exchange.update(position.data());
  exchange.update(velocity.data());
  exchange.update(inertia.data());
  update_first_velocity();
}

void NodeHalo::update_first_velocity()
{
  if (std::all_of(all_bodies.begin(), all_bodies.end(),
                  [](const Body *body)
                  { return body->nodes().n_substeps == 1; }))
    return first_velocity.clear();
  first_velocity = velocity;
  for (std::size_t s = 0; s < n_owned(); ++s)
  {
    const NodalState &nodes = all_bodies[owned_body[s]]->nodes();
    if (!nodes.first_velocity.empty())
      first_velocity[s] = nodes.first_velocity[owned_local[s]];
  }
  exchange.update(first_velocity.data());
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

std::vector<GlobalIndex> NodeHalo::numbers() const
{
  std::vector<GlobalIndex> found;
  for (const NodeKey &k : key_of_slot)
    found.push_back(k.node * GlobalIndex(all_bodies.size()) + k.body);
  return found;
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
