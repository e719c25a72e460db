#ifndef sabot_bodies_spg_bond_list_h
#define sabot_bodies_spg_bond_list_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/bodies/spg/bond_rows.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/kernels/vec.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
class MirrorPlanes;

/**
 * The bonds of the owned particles as one compressed list, each row sorted by
 * the global number of the neighbor. A bond is stored from both of its ends;
 * reverse[] leads from one to the other. Rows only get shorter, unless
 * connect() takes over new ones. What others keep per bond follows by carry()
 * after connect() and remove().
 *
 * Owned row i is [begin(i), end(i)); begin(i) is a multiple of bonds_per_pack,
 * and behind end(i) there are unused places, to whole packs and after removals.
 * There the particle is its own neighbor with weights zero, and carry() leaves
 * zeros, so that loops over packs need no test: they go on to packed_end(i).
 * Arrays over bonds have capacity() places, then the ghosts' bonds that end
 * here. A bond is a pair of local indices; it has its
 * state at both ends, each owned by the rank of its particle.
 */
class BondList
{
public:
  /** Bonds that loops take at once (Pack). */
  static constexpr std::size_t bonds_per_pack = 4;
  /** Bonds by which loops over reverse[] ask for data beforehand: where the
      other end of a bond is kept no processor guesses. */
  static constexpr std::size_t look_ahead = 64;

  /** Row of neighbors, by global number, of every owned particle. */
  using Rows = BondRows;

  /**
   * Rows of points closer than @p support in units of @p spacing per axis: by
   * distance, or with @p cubic along every axis. @p owned_ids: global numbers
   * of this rank's particles, ascending. Throws std::invalid_argument for
   * points that coincide.
   *
   * Buckets of one support, so the time is linear in the number of points.
   * Points [m] are all of the body, by global number; the edge itself is
   * outside (1e-9 of the support).
   */
  static Rows rows_within(const std::vector<std::array<double, 3>> &points,
                          const std::array<double, 3> &spacing,
                          const double support, const bool cubic,
                          const std::vector<GlobalIndex> &owned_ids);

  /**
   * Rows of points of which one lies in the kernel of the other: |H^-1 dX| < 1,
   * or with @p cubic each component below 1. @p kernel: H of every point, or
   * one for all. Throws std::invalid_argument for points that coincide.
   *
   * Symmetric by construction: each rank finds a bond from both of its ends.
   * Points and H in m, all of the body by global number. Local: every rank has
   * all points at the start.
   */
  static Rows rows_in_kernels(const std::vector<std::array<double, 3>> &points,
                              const AlignedVector<Mat> &kernel,
                              const bool cubic,
                              const std::vector<GlobalIndex> &owned_ids);

  /** Numbers in @p rows that are not owned, ascending. Each number once.
      Local. */
  static std::vector<GlobalIndex>
  ghosts_of(const Rows &rows, const std::vector<GlobalIndex> &owned_ids);

  /** From now on neighbors may be mirror images, numbered by @p planes, which
      outlive this; they count as ghosts, also where this rank has the particle
      itself. @p on_planes: of the owned particles, MirrorPlanes::planes_at().
      Local. */
  void reflect_in(const MirrorPlanes &planes,
                  std::vector<std::uint8_t> on_planes);

  /** Take over @p rows when ghosts are numbered; they are let go on the way.
      @p global_id of all local
      particles, owners of the ghosts. Collective. Rows [n_owned] ascend.
      Weights are not those of the new bonds before
      ParticleApproximation::update(); origin remembers
      which bonds were there before, for carry(). Throws std::logic_error where
      a bond is there from one end only. */
  void connect(Rows rows, const std::vector<GlobalIndex> &global_id,
               const std::vector<int> &ghost_owner, const GlobalIndex n_global,
               MPI_Comm communicator);

  /** Remove the bonds with dead[bond] != 0, marked from both ends alike on
      all ranks. Collective. @return whether there were any on any rank.
      dead: over capacity(). Rows close up in place and keep their order;
      reverse[] follows, and where a bond of any rank went the exchange of
      ghosts' bonds is built anew. */
  bool remove(const std::vector<char> &dead);
  /** The same where the caller knows the rows that have marks, @p rows of owned
      particles, ascending; arrays follow by carry_rows(). */
  bool remove(const std::vector<char> &dead,
              const std::vector<std::uint32_t> &rows);

  /** Let an array over bonds follow the last connect() or remove(): values
      of bonds that stayed move to their new places, new bonds get zeros,
      ghosts' bonds room. Call exactly once per array and change, before
      settle(). Local;
      after connect() ghosts' entries have to be exchanged by
      update_ghosts(). */
  template <typename Array>
  void carry(Array &data) const
  {
    // In place, for such arrays are the largest that there are. Bonds keep
    // their order: those that move down find room from the first on, those
    // that move up from the last.
    const typename Array::value_type none = {};
    if (origin.empty())
      return data.assign(n_with_ghosts(), none);
    data.reserve(n_with_ghosts());
    data.resize(std::max(data.size(), n_with_ghosts()));
    for (std::size_t i = 0; i < n_owned; ++i)
      for (std::size_t b = begin(i); b < end(i); ++b)
        if (origin[b] != is_new && origin[b] > b)
          data[b] = data[origin[b]];
    for (std::size_t i = n_owned; i-- > 0;)
      for (std::size_t b = end(i); b-- > begin(i);)
        if (origin[b] < b)
          data[b] = data[origin[b]];
    for (std::size_t i = 0; i < n_owned; ++i)
    {
      for (std::size_t b = begin(i); b < end(i); ++b)
        if (origin[b] == is_new)
          data[b] = none;
      for (std::size_t b = end(i); b < row_start[i + 1]; ++b)
        data[b] = none;
    }
    std::fill(data.begin() + capacity(), data.end(), none);
    data.resize(n_with_ghosts());
  }

  /** carry() after remove() from these rows alone. */
  template <typename Array>
  void carry_rows(Array &data, const std::vector<std::uint32_t> &rows) const
  {
    const typename Array::value_type none = {};
    for (const std::uint32_t i : rows)
    {
      for (std::size_t b = begin(i); b < end(i); ++b)
        data[b] = data[origin[b]];
      std::fill(data.begin() + end(i), data.begin() + row_start[i + 1], none);
    }
    data.resize(n_with_ghosts());
  }

  /** Owned particles that had bonds to ghosts or images when they were last
      connected, ascending; bonds may have gone since. */
  const std::vector<std::uint32_t> &rows_at_ghosts() const { return at_ghosts; }
  /** How often bonds came or went so far; the same on all ranks. */
  std::size_t n_changes() const { return changes; }

  /** All arrays have been carried: forget where bonds were. */
  void settle() { std::vector<std::uint32_t>().swap(origin); }

  void list_memory(MemoryTable &table) const
  {
    table.add("bonds: neighbors", neighbor);
    table.add("bonds: other ends", reverse);
    table.add("bonds: weights", weight);
    table.add("bonds: scaled weights", scaled_weight);
    table.add("bonds: former places", origin);
    table.add("rows of bonds: starts", row_start);
    table.add("rows of bonds: lengths", count);
    table.add("rows of bonds: node numbers", id);
    table.add("rows of bonds: at ghosts", at_ghosts);
  }

  std::size_t begin(const std::size_t i) const { return row_start[i]; }
  std::size_t end(const std::size_t i) const { return row_start[i] + count[i]; }
  /** end(i) rounded up to whole packs. */
  std::size_t packed_end(const std::size_t i) const
  {
    return row_start[i] + packed(count[i]);
  }
  /** Of owned particle i the first bond to a neighbor of this global number or
      of a larger one, or end(i). */
  std::size_t first_from(const std::size_t i, const GlobalIndex number) const
  {
    return std::lower_bound(neighbor.begin() + begin(i),
                            neighbor.begin() + end(i), number,
                            [this](const std::uint32_t j, const GlobalIndex n)
                            { return id[j] < n; }) -
           neighbor.begin();
  }
  /** Bonds of owned particle i that have not failed. */
  std::size_t n_bonds(const std::size_t i) const { return count[i]; }
  /** Places of bonds of owned particles, used or not; constant between two
      calls of connect(). */
  std::size_t capacity() const { return neighbor.size(); }
  /** Capacity and the bonds of ghosts that end here. */
  std::size_t n_with_ghosts() const
  {
    return neighbor.size() + exchange.n_ghosts();
  }

  /** Fill the entries of ghosts' bonds in an array over n_with_ghosts();
      collective. data [n_with_ghosts()]: entries from capacity() on are
      filled by the owners of these bonds. */
  template <typename T>
  void update_ghosts(T *data) const
  {
    exchange.update(data);
  }

  AlignedVector<std::uint32_t> neighbor; // local index
  /** The same bond seen from the neighbor: data[reverse[b]] is its value at
      the other end, ghosts' included. Behind capacity() there are look_ahead
      places more, zero. */
  std::vector<std::uint32_t> reverse; // into arrays over n_with_ghosts()
  /** Symmetric weights, set by ParticleApproximation::update(): phi, and phi
      times the mean of |xi|^2 at both ends over |dX|^2 [1/m^2], the weight in
      units of the kernel's size. In single precision: any symmetric numbers
      near those of the spline make consistent functions, as long as moments
      are sums of the very numbers that are stored. */
  AlignedVector<float> weight, scaled_weight;

  std::vector<std::uint32_t> count; // of bonds in each row
  /** As arrays over bonds of a state have them; @p owned: the particles. */
  StateRows rows(const StateItems &owned, const std::string &name) const
  {
    return {owned, name, row_start.data(), count.data()};
  }

private:
  /** Close up row @p i. @return whether any of its bonds went. */
  bool remove_from_row(const std::size_t i, const std::vector<char> &dead);
  /** After removals on this rank or not: whether there were any on any rank,
      which change what is exchanged. Collective. */
  bool settle_removal(int has_changed);
  /** Finds reverse[] and the exchange of ghosts' bonds again. Collective. */
  void reconnect();
  /** Of bonds to ghosts and images alone. Collective. */
  void connect_ghosts();
  /** reverse[] of bonds between owned particles. Throws std::logic_error where
      the two ends do not agree. */
  void reverse_owned();
  /** What bonds to one ghost or image have in common. */
  struct Ghost
  {
    GlobalIndex particle;
    unsigned int back, turned_axes; // the symmetry that undoes its own, 0: none
  };
  std::vector<Ghost> ghosts_and_images() const;
  /** Bond of owned particle i to the neighbor with this global number.
      Throws std::logic_error where there is none: the two ends must agree. */
  std::size_t find(const std::size_t i, const GlobalIndex neighbor_id) const;

  static constexpr std::uint32_t is_new = 0xffffffffu;

  static std::size_t packed(const std::size_t n)
  {
    return (n + bonds_per_pack - 1) / bonds_per_pack * bonds_per_pack;
  }

  std::vector<std::size_t> row_start;
  /** Before the last change, of carry(); empty where there were no bonds. */
  std::vector<std::uint32_t> origin;
  std::vector<GlobalIndex> id; // global numbers of local particles
  std::vector<int> owner_of_ghost;
  std::vector<std::uint32_t> at_ghosts; // see rows_at_ghosts()
  GlobalIndex n_total = 0;
  std::size_t n_owned = 0;
  std::size_t changes = 0;
  MPI_Comm communicator = MPI_COMM_SELF;
  MirroredExchange exchange;
  const MirrorPlanes *mirror = nullptr; // null: there are no images
  std::vector<std::uint8_t> on_planes;  // of owned particles
};
} // namespace sabot

#endif
