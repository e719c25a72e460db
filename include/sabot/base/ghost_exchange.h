#ifndef sabot_base_ghost_exchange_h
#define sabot_base_ghost_exchange_h

#include "sabot/base/types.h"

#include <mpi.h>

#include <cstring>
#include <vector>

namespace sabot
{
/**
 * Copies values of owned items to the ranks that hold them as ghosts.
 * The arrays have n_owned + n_ghost entries, ghosts last. Built once per
 * neighbourhood; an update moves each value as one block of bytes.
 */
class GhostExchange
{
public:
  GhostExchange() = default;

  /**
   * @param ghost_owner  rank that owns each ghost
   * @param ghost_key    key by which that rank knows the item
   * @param find_owned   key -> index of the owned item there
   * All ranks must call it.
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

  /** Fill the ghost entries of @p data; all ranks must call it. */
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
  bool is_trivial() const { return peer.empty(); }

private:
  std::vector<GlobalIndex> set_up(const std::vector<int> &ghost_owner,
                                  const std::vector<GlobalIndex> &ghost_key);
  void transfer(const std::size_t item_size) const;

  MPI_Comm communicator = MPI_COMM_SELF;
  std::size_t n_owned = 0;
  std::vector<int> peer; // ranks with which anything is exchanged
  std::vector<std::size_t> send_start, receive_start; // per peer
  std::vector<std::size_t> send_item;    // owned indices, peer by peer
  std::vector<std::size_t> receive_item; // ghost numbers, peer by peer
  mutable std::vector<char> send_buffer, receive_buffer;
};
} // namespace sabot

#endif
