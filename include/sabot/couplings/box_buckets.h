#ifndef sabot_couplings_box_buckets_h
#define sabot_couplings_box_buckets_h

#include "sabot/kernels/vec.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * A box along the axes [m], closed on all sides; empty at first, with the low
 * corner above the high one, so that an empty box contains nothing and meets
 * nothing. Not-a-number is inside of no box.
 */
struct Box
{
  Vec low = {1e300, 1e300, 1e300, 0}, high = {-1e300, -1e300, -1e300, 0};

  /** Grow until it has @p x. */
  void add(const Vec x)
  {
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  /** Move all sides outwards by @p r [m]. */
  void inflate(const double r)
  {
    low -= vec(r, r, r);
    high += vec(r, r, r);
  }
  bool contains(const Vec x) const
  {
    for (int d = 0; d < 3; ++d)
      if (!(x[d] >= low[d] && x[d] <= high[d]))
        return false;
    return true;
  }
  /** From @p x to the closest point of the box, squared; 0 inside [m^2]. */
  double distance_square(const Vec x) const
  {
    const Vec below = low - x, above = x - high, zero = {};
    Vec away = below > above ? below : above;
    away = away > zero ? away : zero;
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += away[d] * away[d];
    return square;
  }
  /** Largest gap along an axis [m]; negative where the boxes overlap. Bodies
      whose boxes are this far apart have to travel as far before they meet. */
  double distance(const Box &o) const;
  /** Whether they have a point in common. */
  bool meets(const Box &o) const;
  /** Make it the box around the boxes of all ranks. Collective. */
  void reduce(MPI_Comm communicator);
};

/** The boxes of all ranks, by rank. Collective. */
std::vector<Box> boxes_of_ranks(const Box &mine, MPI_Comm communicator);

/**
 * Boxes by the buckets of a regular grid that they cover, as one compressed
 * list: bucket (k n_y + j) n_x + i holds items[start[b]] to items[start[b + 1]
 * - 1]. Building costs the number of boxes times the buckets that each covers,
 * a look-up nothing but its answer.
 */
class BoxBuckets
{
public:
  /** @p boxes: of the items, none of them empty; @p size: of a bucket [m],
      about that of the boxes. It is made larger in steps of 1.3 until there are
      at most 20 buckets per box, for boxes may be far between. */
  BoxBuckets(const std::vector<Box> &boxes, double size);

  /** Items whose box may contain @p x, ascending, as first and last of a range;
      boxes are not looked at again, so some of them may not. */
  std::pair<const std::int32_t *, const std::int32_t *> find(const Vec x) const;

private:
  /** Calls @p action(bucket) for the buckets that @p box covers. */
  template <typename Action>
  void for_all(const Box &box, const Action &action) const;

  Vec low;                                  // corner of the grid [m]
  double scale = 0.;                        // buckets per length [1/m]
  std::array<std::int64_t, 3> n{{0, 0, 0}}; // buckets along the axes
  std::vector<std::int32_t> start, items;
};
} // namespace sabot

#endif
