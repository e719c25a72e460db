#ifndef sabot_bodies_spg_bond_list_h
#define sabot_bodies_spg_bond_list_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * The bonds of the owned particles as one compressed list, each row sorted by
 * the global number of the neighbour. A bond is stored from both of its ends;
 * reverse[] leads from one to the other. Bonds are only ever removed: a row
 * keeps its place and gets shorter.
 */
class BondList
{
public:
  /**
   * Bonds between points closer than @p support in units of @p spacing per
   * axis. @p owned_ids: global numbers of this rank's particles, ascending.
   * @return global numbers of the neighbours that are not owned, ascending.
   */
  std::vector<GlobalIndex>
  build(const std::vector<std::array<double, 3>> &points,
        const std::array<double, 3> &spacing, const double support,
        const std::vector<GlobalIndex> &owned_ids);

  /** Second half of the set-up, when ghosts are numbered. @p global_id of all
      local particles, owners of the ghosts. Collective. */
  void connect(const std::vector<GlobalIndex> &global_id,
               const std::vector<int> &ghost_owner, const GlobalIndex n_global,
               MPI_Comm communicator);

  /** Remove the bonds with dead[bond] != 0, marked from both ends alike on
      all ranks. Collective. @return number removed on this rank. */
  std::size_t remove(const std::vector<char> &dead);

  std::size_t begin(const std::size_t i) const { return row_start[i]; }
  std::size_t end(const std::size_t i) const { return row_start[i] + count[i]; }
  std::size_t n_bonds(const std::size_t i) const { return count[i]; }
  std::size_t n_initial(const std::size_t i) const
  {
    return row_start[i + 1] - row_start[i];
  }
  std::size_t capacity() const { return neighbor.size(); }

  /** Copy the forces of bonds that end here from the ranks that own their
      start; collective. */
  void exchange_forces() { exchange.update(force.data()); }

  std::vector<std::uint32_t> neighbor; // local index
  std::vector<std::uint32_t> reverse;  // into force[]
  std::vector<double> weight;          // symmetric kernel weight
  AlignedVector<Vec> rest;             // Xi: residual-free bond vector
  AlignedVector<Vec> force;            // [capacity + bonds of ghosts]

  /** Rows, for checkpoints. After overwriting them, call reconnect(). */
  std::vector<std::uint32_t> count;
  void reconnect();

private:
  std::size_t find(const std::size_t i, const GlobalIndex neighbor_id) const;

  std::vector<std::size_t> row_start;
  std::vector<GlobalIndex> id; // global numbers of local particles
  std::vector<int> owner_of_ghost;
  GlobalIndex n_total = 0;
  std::size_t n_owned = 0;
  MPI_Comm communicator = MPI_COMM_SELF;
  GhostExchange exchange;
  std::vector<std::vector<GlobalIndex>> row_ids; // during the set-up only
};
} // namespace sabot

#endif
