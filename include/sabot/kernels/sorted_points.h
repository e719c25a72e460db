#ifndef sabot_kernels_sorted_points_h
#define sabot_kernels_sorted_points_h

#include "sabot/kernels/pack_math.h"
#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Points in the order of the cubes of edge @p reach [m] in which they lie, for
 * a search of all that are near each of them. Cubes are numbered from the
 * lowest corner, x first, so that those beside one along x are one stretch of
 * the list, and where it is goes up from cube to cube: a search without tables.
 */
class SortedPoints
{
public:
  /** @p place(k): of point k of @p n [m]. */
  template <typename Place>
  SortedPoints(const std::size_t n, const Place &place, const double reach)
      : reach(reach), order(n)
  {
    Vec low = {1e300, 1e300, 1e300, 0.};
    for (std::size_t k = 0; k < n; ++k)
    {
      const Vec point = place(k);
      for (int d = 0; d < 3; ++d)
        low[d] = std::min(low[d], point[d]);
    }
    for (std::size_t k = 0; k < n; ++k)
    {
      // From 1 on; farther than a million cubes all are in the last one.
      const Vec point = place(k);
      std::int64_t cube = 0;
      for (int d = 2; d >= 0; --d)
      {
        const double from_low = (point[d] - low[d]) / reach;
        cube = (cube << bits) +
               static_cast<std::int64_t>(1. + std::min(from_low, 1e6));
      }
      order[k] = {cube, static_cast<std::uint32_t>(k)};
    }
    std::sort(order.begin(), order.end());
    // Behind the last one stands what is far from all.
    for (int d = 0; d < 3; ++d)
      x[d].resize(n + n_wide, 1e150);
    number.resize(n + n_wide);
    for (std::size_t at = 0; at < n; ++at)
    {
      number[at] = order[at].second;
      const Vec point = place(number[at]);
      for (int d = 0; d < 3; ++d)
        x[d][at] = point[d];
    }
  }

  /** Call @p visit(k, near, n) for every point k that @p wanted(k) says, with
      the n points closer to it than the reach, itself among them, in no
      order. */
  template <typename Wanted, typename Visit>
  void for_each(const Wanted &wanted, const Visit &visit) const
  {
    std::size_t first[9] = {}, last[9] = {};
    std::vector<std::uint32_t> near;
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)
    {
      const std::int64_t cube = order[begin].first;
      while (end < order.size() && order[end].first == cube)
        ++end;
      std::size_t n_candidates = 0;
      for (int side = 0; side < 9; ++side)
      {
        const std::int64_t middle =
            cube + (side % 3 - 1) * step(1) + (side / 3 - 1) * step(2);
        advance(first[side], middle - 1);
        last[side] = std::max(last[side], first[side]);
        advance(last[side], middle + 2);
        n_candidates += last[side] - first[side];
      }
      near.resize(n_candidates + n_wide);
      for (std::size_t at = begin; at < end; ++at)
      {
        if (!wanted(order[at].second))
          continue;
        std::size_t n = 0;
        for (int side = 0; side < 9; ++side)
          n = collect(at, first[side], last[side], near.data(), n);
        visit(order[at].second, near.data(), n);
      }
    }
  }

private:
  static constexpr int bits = 21;
  /** Between cubes that are neighbors along y (1) or z (2). */
  static std::int64_t step(const int axis)
  {
    return std::int64_t(1) << bits * axis;
  }
  /** To the first point in this cube or behind it. */
  void advance(std::size_t &at, const std::int64_t cube) const
  {
    while (at < order.size() && order[at].first < cube)
      ++at;
  }
  /** Append those of [first, last) that are near to @p near, which has n, and
      room for a pack more. */
  std::size_t collect(const std::size_t at, const std::size_t first,
                      const std::size_t last, std::uint32_t *const near,
                      std::size_t n) const
  {
    const double x0 = x[0][at], y0 = x[1][at], z0 = x[2][at];
    for (std::size_t k = first; k < last; k += n_wide)
    {
      const WidePack dx = load_wide(&x[0][k]) - x0,
                     dy = load_wide(&x[1][k]) - y0,
                     dz = load_wide(&x[2][k]) - z0;
      const WideMask is_near = dx * dx + dy * dy + dz * dz < reach * reach;
      if (!any_of(is_near))
        continue;
      const std::size_t n_lanes = std::min(n_wide, last - k);
      for (std::size_t lane = 0; lane < n_lanes; ++lane)
      {
        near[n] = number[k + lane];
        n -= is_near[lane];
      }
    }
    return n;
  }

  const double reach;
  std::vector<std::pair<std::int64_t, std::uint32_t>> order; // cube, number
  // In this order
  std::vector<double> x[3];
  std::vector<std::uint32_t> number;
};
} // namespace sabot

#endif
