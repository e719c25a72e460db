#ifndef sabot_base_ghost_exchange_h
#define sabot_base_ghost_exchange_h

#include "sabot/base/types.h"

#include <mpi.h>

#include <cstring>
#include <vector>

namespace sabot
{
/**
 * Copies values of owned items (nodes, bonds) to the ranks that hold them as
 * ghosts. The arrays have n_owned + n_ghost entries, ghosts last. Built once
 * per neighborhood; an update moves each value as one block of bytes, so that
 * any type without pointers will do and its bits arrive as they were.
 *
 * Who sends what to whom is found by the owners themselves: a rank tells the
 * owner of each ghost the key under which it wants it, and gets the values in
 * that order from then on:
 *
 *     GhostExchange exchange(communicator, nodes.n_owned, owner, id,
 *                            [&](GlobalIndex i) { return local_number(i); });
 *     exchange.update(nodes.velocity.data());
 *
 * Messages go to neighbors only, all at once, without waiting for any in
 * particular; each update is one message per pair of ranks and direction. A
 * ghost may be a copy of what its own rank has, which needs no message. Where
 * no rank shares anything, all functions return at once.
 */
class GhostExchange
{
public:
  GhostExchange() = default;

  /**
   * Agree with the other ranks on what is sent. Collective.
   * @param n_owned      items before the first ghost
   * @param ghost_owner  [n_ghost], rank that owns each ghost
   * @param ghost_key    [n_ghost], key by which that rank knows the item
   * @param find_owned   called with a key, gives the index of the owned item
   *                     there; it must exist
   */
  template <typename Find>
  GhostExchange(MPI_Comm communicator, const std::size_t n_owned,
                const std::vector<int> &ghost_owner,
                const std::vector<GlobalIndex> &ghost_key,
                const Find &find_owned)
      : communicator(communicator), n_owned(n_owned)
  {
    std::vector<GlobalIndex> asked = set_up(ghost_owner, ghost_key);
    send_item.reserve(asked.size());
    for (const GlobalIndex key : asked)
      send_item.push_back(find_owned(key));
  }

  /** Fill the ghost entries of @p data, [n_owned + n_ghost], with what their
      owners have. Collective: all ranks that share items must call it for the
      same array. The rank that owns nothing of others' still sends. */
  template <typename T>
  void update(T *data) const
  {
    if (is_trivial())
      return;
    send_buffer.resize(send_item.size() * sizeof(T));
    receive_buffer.resize(receive_item.size() * sizeof(T));
    for (std::size_t i = 0; i < send_item.size(); ++i)
      std::memcpy(&send_buffer[i * sizeof(T)], &data[send_item[i]], sizeof(T));
    transfer(sizeof(T));
    for (std::size_t i = 0; i < receive_item.size(); ++i)
      std::memcpy(static_cast<void *>(&data[n_owned + receive_item[i]]),
                  &receive_buffer[i * sizeof(T)], sizeof(T));
  }

  std::size_t n_ghosts() const { return receive_item.size(); }
  /** Whether this rank neither sends nor receives. */
  bool is_trivial() const { return peer.empty(); }

private:
  /** Tell the owners what is wanted of them. @return the keys that are wanted
      of this rank, peer by peer. Collective. */
  std::vector<GlobalIndex> set_up(const std::vector<int> &ghost_owner,
                                  const std::vector<GlobalIndex> &ghost_key);
  /** Exchange the buffers with all peers, items of @p item_size bytes. */
  void transfer(const std::size_t item_size) const;

  MPI_Comm communicator = MPI_COMM_SELF;
  std::size_t n_owned = 0;
  int own_rank = -1;
  std::vector<int> peer; // ranks with which anything is exchanged
  std::vector<std::size_t> send_start, receive_start; // per peer
  std::vector<std::size_t> send_item;    // owned indices, peer by peer
  std::vector<std::size_t> receive_item; // ghost numbers, peer by peer
  // Kept between calls: they are as long each time.
  mutable std::vector<char> send_buffer, receive_buffer;
};
} // namespace sabot

#endif
