#ifndef sabot_kernels_point_buckets_h
#define sabot_kernels_point_buckets_h

#include "sabot/kernels/vec.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>
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
    buckets[key(x, 0, 0, 0)].push_back(item);
  }
  /** Calls @p action(item) for at least all items closer than the reach, in an
      order that depends only on @p x and the order of add(): sums over what is
      found are the same on every rank that added the same points. Items farther
      than the reach may come, too; the caller looks at distances. */
  template <typename Action>
  void for_near(const Vec x, const Action &action) const
  {
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
        {
          const auto bucket = buckets.find(key(x, dx, dy, dz));
          if (bucket != buckets.end())
            for (const std::size_t item : bucket->second)
              action(item);
        }
  }

private:
  /** Number of the cube that is (dx, dy, dz) cubes from that of @p x. */
  std::int64_t key(const Vec x, const int dx, const int dy, const int dz) const
  {
    constexpr std::int64_t mask = (1 << 21) - 1;
    const std::int64_t i = std::floor(x[0] * scale),
                       j = std::floor(x[1] * scale),
                       k = std::floor(x[2] * scale);
    return ((i + dx) & mask) << 42 | ((j + dy) & mask) << 21 |
           ((k + dz) & mask);
  }
  const double scale; // cubes per length [1/m]
  std::unordered_map<std::int64_t, std::vector<std::size_t>> buckets;
};
} // namespace sabot

#endif
