#ifndef sabot_couplings_node_halo_h
#define sabot_couplings_node_halo_h

#include "sabot/base/gather_all.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"

#include <vector>

namespace sabot
{
/** A node among all bodies: body number and global number in the body. Sorted
    by body, then by number, which is the order of every sum over nodes. Ranks
    send it as it is in memory. */
struct NodeKey
{
  std::int32_t body;
  std::int32_t padding = 0;
  GlobalIndex node;

  bool operator<(const NodeKey &o) const
  {
    return body != o.body ? body < o.body : node < o.node;
  }
  bool operator==(const NodeKey &o) const
  {
    return body == o.body && node == o.node;
  }
};

/**
 * Copies of the motion of a few nodes of any bodies, wherever they live: what a
 * coupling needs to compute its forces. Each node has a slot; slots are
 * numbered owned nodes first, ascending by key, then those of other ranks,
 * ascending. A node that another rank asks for has a slot on its owner, too,
 * whether that rank asked for it or not.
 */
class NodeHalo
{
public:
  /** @p keys: nodes this rank needs (any order, repeats allowed); @p bodies:
      indexed by NodeKey::body. Collective. */
  void build(const std::vector<Body *> &bodies, std::vector<NodeKey> keys,
             MPI_Comm communicator);
  /** Refresh position, velocity and inertia of all slots from the bodies, in
     the current frame. A tied follower, which has no inertia of its own, counts
      with its lumped mass: a safe (low) measure of what resists. Collective. */
  void update();
  /** Present uniaxial flow stress at all slots [Pa], Body::flow_stress(). Costs
      a return mapping per node: asked for at searches only. Collective. */
  void find_flow_stress(std::vector<double> &of_slots) const;
  /** Slot of a key that was asked for; std::logic_error for another one. Costs
      the logarithm of size(). */
  std::size_t slot(const NodeKey &key) const;
  /** Fill the entries of the nodes owned elsewhere, @p data [size()], with what
      their owners have in theirs. Collective. */
  template <typename T>
  void update_ghosts(T *data) const
  {
    exchange.update(data);
  }
  /** Body and local number of an owned slot, @p slot < n_owned(). */
  const Body &body(const std::size_t slot) const
  {
    return *all_bodies[owned_body[slot]];
  }
  std::size_t local(const std::size_t slot) const { return owned_local[slot]; }
  /** Add slot forces [N] of the owned nodes to their bodies; those of other
      slots are left, for their owners compute them, too. */
  void add_to_bodies(const AlignedVector<Vec> &force) const;

  /** Another one since positions are others. */
  std::uint64_t version() const { return n_updates; }
  std::size_t n_owned() const { return owned_body.size(); }
  std::size_t size() const { return key_of_slot.size(); }
  const NodeKey &key(const std::size_t slot) const { return key_of_slot[slot]; }
  /** Keys of all slots as one number each, for arrays of a state; of the bodies
      that the halo was built of. */
  std::vector<GlobalIndex> numbers() const;
  std::size_t n_bodies() const { return all_bodies.size(); }
  /** Velocity of an owned slot in its body, now, [m/s]; the copy in velocity is
      that of the last update(). */
  Vec body_velocity(const std::size_t slot) const
  {
    return all_bodies[owned_body[slot]]->nodes().velocity[owned_local[slot]];
  }

  /** Of the first substep where any body makes several, else that of the step,
      [m/s]. */
  const AlignedVector<Vec> &start_velocity() const
  {
    return first_velocity.empty() ? velocity : first_velocity;
  }

  AlignedVector<Vec> position, velocity; // [size()], m and m/s
  std::vector<double> inertia; // [size()], mass with that of followers [kg]

private:
  /** first_velocity, where it is needed. Collective. */
  void update_first_velocity();
  /** Where the slots of the owned nodes @p owned are. */
  void take_owned(const std::vector<NodeKey> &owned);
  /** Slots for owned nodes that other ranks ask for. */
  void add_asked(const std::vector<NodeKey> &asked);

  std::vector<Body *> all_bodies;
  AlignedVector<Vec> first_velocity; // [size()] or empty
  std::vector<NodeKey> key_of_slot;  // owned ascending, then others ascending
  // Of the owned slots.
  std::vector<std::int32_t> owned_body;
  std::vector<std::size_t> owned_local;
  GhostExchange exchange;
  std::uint64_t n_updates = 0;
};
} // namespace sabot

#endif
