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
 * the global number of the neighbor. A bond is stored from both of its ends;
 * reverse[] leads from one to the other. Rows only get shorter, unless
 * connect() takes over new ones. What others keep per bond follows by carry()
 * after connect() and remove().
 */
class BondList
{
public:
  /** Row of neighbors, by global number, of every owned particle. */
  using Rows = std::vector<std::vector<GlobalIndex>>;

  /**
   * Rows of points closer than @p support in units of @p spacing per axis: by
   * distance, or with @p cubic along every axis. @p owned_ids: global numbers
   * of this rank's particles, ascending. Throws std::invalid_argument for
   * points that coincide.
   */
  static Rows rows_within(const std::vector<std::array<double, 3>> &points,
                          const std::array<double, 3> &spacing,
                          const double support, const bool cubic,
                          const std::vector<GlobalIndex> &owned_ids);

  /**
   * Rows of points of which one lies in the kernel of the other: |H^-1 dX| < 1,
   * or with @p cubic each component below 1. @p kernel: H of every point, or
   * one for all. Throws std::invalid_argument for points that coincide.
   */
  static Rows rows_in_kernels(const std::vector<std::array<double, 3>> &points,
                              const AlignedVector<Mat> &kernel,
                              const bool cubic,
                              const std::vector<GlobalIndex> &owned_ids);

  /** Numbers in @p rows that are not owned, ascending. */
  static std::vector<GlobalIndex>
  ghosts_of(const Rows &rows, const std::vector<GlobalIndex> &owned_ids);

  /** Take over @p rows when ghosts are numbered. @p global_id of all local
      particles, owners of the ghosts. Collective. */
  void connect(const Rows &rows, const std::vector<GlobalIndex> &global_id,
               const std::vector<int> &ghost_owner, const GlobalIndex n_global,
               MPI_Comm communicator);

  /** Remove the bonds with dead[bond] != 0, marked from both ends alike on
      all ranks. Collective. @return whether there were any on any rank. */
  bool remove(const std::vector<char> &dead);

  /** Let an array over bonds follow the last connect() or remove(): values of
      bonds that stayed move to their new places, new bonds get zeros, ghosts'
      bonds room. */
  template <typename Array>
  void carry(Array &data) const
  {
    Array old;
    old.swap(data);
    data.resize(n_with_ghosts());
    for (std::size_t i = 0; i < n_owned; ++i)
      for (std::size_t b = begin(i); b < end(i); ++b)
        if (origin[b] != is_new)
          data[b] = old[origin[b]];
  }

  std::size_t begin(const std::size_t i) const { return row_start[i]; }
  std::size_t end(const std::size_t i) const { return row_start[i] + count[i]; }
  std::size_t n_bonds(const std::size_t i) const { return count[i]; }
  std::size_t capacity() const { return neighbor.size(); }
  /** Capacity and the bonds of ghosts that end here. */
  std::size_t n_with_ghosts() const
  {
    return neighbor.size() + exchange.n_ghosts();
  }

  /** Fill the entries of ghosts' bonds in an array over n_with_ghosts();
      collective. */
  template <typename T>
  void update_ghosts(T *data) const
  {
    exchange.update(data);
  }

  std::vector<std::uint32_t> neighbor; // local index
  std::vector<std::uint32_t> reverse;  // into arrays over n_with_ghosts()
  /** Symmetric weights, set by Approximation::update(): phi, and phi times the
      mean of |xi|^2 at both ends over |dX|^2 [1/m^2], the weight in units of
      the kernel's size. */
  std::vector<double> weight, scaled_weight;

  /** Rows, for checkpoints. After overwriting them, call reconnect(). */
  std::vector<std::uint32_t> count;
  void reconnect();

private:
  std::size_t find(const std::size_t i, const GlobalIndex neighbor_id) const;

  static constexpr std::uint32_t is_new = 0xffffffffu;

  std::vector<std::size_t> row_start;
  std::vector<std::uint32_t> origin; // before the last change, of carry()
  std::vector<GlobalIndex> id;       // global numbers of local particles
  std::vector<int> owner_of_ghost;
  GlobalIndex n_total = 0;
  std::size_t n_owned = 0;
  MPI_Comm communicator = MPI_COMM_SELF;
  GhostExchange exchange;
};
} // namespace sabot

#endif
