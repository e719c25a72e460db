// Copies what owned nodes have to the ghosts of other ranks.
#include "sabot/base/ghost_exchange.h"

#include <algorithm>
#include <numeric>

namespace sabot
{
std::vector<GlobalIndex>
GhostExchange::set_up(const std::vector<int> &ghost_owner,
                      const std::vector<GlobalIndex> &ghost_key)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &own_rank);
  std::vector<int> n_receive(n_ranks, 0), n_send(n_ranks);
  for (const int owner : ghost_owner)
    ++n_receive[owner];
  MPI_Alltoall(n_receive.data(), 1, MPI_INT, n_send.data(), 1, MPI_INT,
               communicator);

  std::vector<int> receive_offset(n_ranks + 1, 0), send_offset(n_ranks + 1, 0);
  std::partial_sum(n_receive.begin(), n_receive.end(),
                   receive_offset.begin() + 1);
  std::partial_sum(n_send.begin(), n_send.end(), send_offset.begin() + 1);

  receive_item.resize(ghost_owner.size());
  std::vector<GlobalIndex> wanted(ghost_owner.size());
  std::vector<int> next(receive_offset.begin(), receive_offset.end() - 1);
  for (std::size_t i = 0; i < ghost_owner.size(); ++i)
  {
    const int slot = next[ghost_owner[i]]++;
    receive_item[slot] = i;
    wanted[slot] = ghost_key[i];
  }
  std::vector<GlobalIndex> asked(send_offset.back());
  MPI_Alltoallv(wanted.data(), n_receive.data(), receive_offset.data(),
                MPI_INT64_T, asked.data(), n_send.data(), send_offset.data(),
                MPI_INT64_T, communicator);
  for (int rank = 0; rank < n_ranks; ++rank)
    if (n_receive[rank] > 0 || n_send[rank] > 0)
    {
      peer.push_back(rank);
      send_start.push_back(send_offset[rank]);
      receive_start.push_back(receive_offset[rank]);
    }
  send_start.push_back(send_offset.back());
  receive_start.push_back(receive_offset.back());
  return asked;
}

void GhostExchange::transfer(const std::size_t item_size) const
{
  constexpr int tag = 17;
  std::vector<MPI_Request> requests;
  requests.reserve(2 * peer.size());
  for (std::size_t p = 0; p < peer.size(); ++p)
  {
    const std::size_t n = receive_start[p + 1] - receive_start[p];
    if (n > 0 && peer[p] == own_rank)
      std::memcpy(&receive_buffer[receive_start[p] * item_size],
                  &send_buffer[send_start[p] * item_size], n * item_size);
    else if (n > 0)
      MPI_Irecv(&receive_buffer[receive_start[p] * item_size], n * item_size,
                MPI_BYTE, peer[p], tag, communicator, &requests.emplace_back());
  }
  for (std::size_t p = 0; p < peer.size(); ++p)
  {
    const std::size_t n = send_start[p + 1] - send_start[p];
    if (n > 0 && peer[p] != own_rank)
      MPI_Isend(&send_buffer[send_start[p] * item_size], n * item_size,
                MPI_BYTE, peer[p], tag, communicator, &requests.emplace_back());
  }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}
} // namespace sabot
