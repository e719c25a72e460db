#ifndef sabot_kernels_point_buckets_h
#define sabot_kernels_point_buckets_h

#include "sabot/kernels/vec.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * Points by the cubes of edge @p reach [m] in which they lie: the neighbors of
 * a point closer than the reach are in its own cube and the 26 around it. Only
 * cubes with points take memory, so points may lie anywhere. Cubes are numbered
 * modulo 2^21 along each axis: points two million cubes apart may come up as
 * near, which the caller's distance tells.
 */
class PointBuckets
{
public:
  explicit PointBuckets(const double reach) : scale(1. / reach) {}
  /** @p item: the caller's number of the point at @p x. */
  void add(const Vec x, const std::size_t item)
  {
    points.push_back({cube_of(x).key(0, 0, 0), item});
    slots.clear();
  }
  /** Calls @p action(item) for at least all items closer than the reach, in an
      order that depends only on @p x and the order of add(): sums over what is
      found are the same on every rank that added the same points. Items farther
      than the reach may come, too; the caller looks at distances. */
  template <typename Action>
  void for_near(const Vec x, const Action &action)
  {
    if (points.empty())
      return;
    if (slots.empty())
      sort();
    const Cube cube = cube_of(x);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
        {
          const Slot &slot = slots[find(cube.key(dx, dy, dz))];
          for (std::size_t k = slot.first; k < slot.last; ++k)
            action(items[k]);
        }
  }

private:
  struct Cube
  {
    std::int64_t i, j, k;
    /** Number of the cube that is (dx, dy, dz) from it. */
    std::int64_t key(const int dx, const int dy, const int dz) const
    {
      constexpr std::int64_t mask = (1 << 21) - 1;
      return ((i + dx) & mask) << 42 | ((j + dy) & mask) << 21 |
             ((k + dz) & mask);
    }
  };
  struct Point
  {
    std::int64_t key;
    std::size_t item;
  };
  /** Of a table with at least twice as many places as points: a cube, or
      nothing. */
  struct Slot
  {
    std::int64_t key = -1;
    std::size_t first = 0, last = 0; // of items
  };

  Cube cube_of(const Vec x) const
  {
    return {std::int64_t(std::floor(x[0] * scale)),
            std::int64_t(std::floor(x[1] * scale)),
            std::int64_t(std::floor(x[2] * scale))};
  }
  /** Place of the cube @p key, or the empty one where it would be. */
  std::size_t find(const std::int64_t key) const
  {
    // The golden ratio spreads neighbors (Knuth, TAOCP 3, 6.4).
    std::size_t place = std::uint64_t(key) * 0x9e3779b97f4a7c15u >> shift;
    while (slots[place].key != key && slots[place].key >= 0)
      place = place + 1 < slots.size() ? place + 1 : 0;
    return place;
  }
  void sort()
  {
    for (shift = 63; (std::size_t(1) << (64 - shift)) < 2 * points.size();)
      --shift;
    slots.resize(std::size_t(1) << (64 - shift));
    for (const Point &p : points)
    {
      Slot &slot = slots[find(p.key)];
      slot.key = p.key;
      ++slot.last;
    }
    std::size_t first = 0;
    for (Slot &slot : slots)
    {
      const std::size_t n = slot.last;
      slot.first = slot.last = first;
      first += n;
    }
    items.resize(points.size());
    for (const Point &p : points)
      items[slots[find(p.key)].last++] = p.item;
  }

  const double scale; // cubes per length [1/m]
  std::vector<Point> points;
  std::vector<std::size_t> items; // cube by cube, as they were added
  std::vector<Slot> slots;        // empty: to be made
  int shift = 63;                 // 64 less the logarithm of their number
};
} // namespace sabot

#endif
