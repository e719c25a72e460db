#ifndef sabot_couplings_node_halo_h
#define sabot_couplings_node_halo_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"

#include <vector>

namespace sabot
{
/** A node among all bodies: body number and global number in the body. */
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
 * Copies of the motion of a few nodes of any bodies, wherever they live:
 * what a coupling needs to compute its forces. Slots are numbered owned nodes
 * first.
 */
class NodeHalo
{
public:
  /** @p keys: nodes this rank needs (any order, repeats allowed); @p bodies:
      indexed by NodeKey::body. Collective. */
  void build(const std::vector<Body *> &bodies, std::vector<NodeKey> keys,
             MPI_Comm communicator);
  /** Refresh position, velocity and inertia of all slots. Collective. */
  void update();
  /** Present flow stress at all slots [Pa]. Collective. */
  void find_flow_stress(std::vector<double> &of_slots) const;
  /** Slot of a key that was asked for. */
  std::size_t slot(const NodeKey &key) const;
  /** Fill the entries of the nodes owned elsewhere. Collective. */
  template <typename T>
  void update_ghosts(T *data) const
  {
    exchange.update(data);
  }
  /** Body and local number of an owned slot. */
  const Body &body(const std::size_t slot) const
  {
    return *all_bodies[owned_body[slot]];
  }
  std::size_t local(const std::size_t slot) const { return owned_local[slot]; }
  /** Add slot forces of the owned nodes to their bodies. */
  void add_to_bodies(const AlignedVector<Vec> &force) const;

  std::size_t n_owned() const { return owned_body.size(); }
  std::size_t size() const { return key_of_slot.size(); }
  const NodeKey &key(const std::size_t slot) const { return key_of_slot[slot]; }
  /** Velocity of an owned slot in its body, now. */
  Vec body_velocity(const std::size_t slot) const
  {
    return all_bodies[owned_body[slot]]->nodes().velocity[owned_local[slot]];
  }

  AlignedVector<Vec> position, velocity; // [size()]
  std::vector<double> inertia;           // [size()]

private:
  std::vector<Body *> all_bodies;
  std::vector<NodeKey> key_of_slot; // owned ascending, then others ascending
  std::vector<std::int32_t> owned_body;
  std::vector<std::size_t> owned_local;
  GhostExchange exchange;
};

/** Concatenate the vectors of all ranks in rank order. Collective. */
template <typename T>
std::vector<T> gather_all(const std::vector<T> &mine, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1)
    return mine;
  const int n_bytes = mine.size() * sizeof(T);
  std::vector<int> sizes(n_ranks), offsets(n_ranks + 1, 0);
  MPI_Allgather(&n_bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator);
  for (int r = 0; r < n_ranks; ++r)
    offsets[r + 1] = offsets[r] + sizes[r];
  std::vector<T> all(offsets[n_ranks] / sizeof(T));
  MPI_Allgatherv(mine.data(), n_bytes, MPI_BYTE, all.data(), sizes.data(),
                 offsets.data(), MPI_BYTE, communicator);
  return all;
}
} // namespace sabot

#endif
