#ifndef sabot_couplings_box_buckets_h
#define sabot_couplings_box_buckets_h

#include "sabot/kernels/vec.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sabot
{
/** Axis-aligned; empty at first. */
struct Box
{
  Vec low = {1e300, 1e300, 1e300, 0}, high = {-1e300, -1e300, -1e300, 0};

  void add(const Vec x)
  {
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  }
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
  /** Largest gap along an axis; negative where the boxes overlap. */
  double distance(const Box &o) const
  {
    double d = -1e300;
    for (int c = 0; c < 3; ++c)
      d = std::max({d, low[c] - o.high[c], o.low[c] - high[c]});
    return d;
  }
  bool meets(const Box &o) const
  {
    for (int d = 0; d < 3; ++d)
      if (!(o.high[d] >= low[d] && o.low[d] <= high[d]))
        return false;
    return true;
  }
  void reduce(MPI_Comm communicator)
  {
    double lows[3] = {low[0], low[1], low[2]},
           highs[3] = {high[0], high[1], high[2]};
    MPI_Allreduce(MPI_IN_PLACE, lows, 3, MPI_DOUBLE, MPI_MIN, communicator);
    MPI_Allreduce(MPI_IN_PLACE, highs, 3, MPI_DOUBLE, MPI_MAX, communicator);
    low = vec(lows[0], lows[1], lows[2]);
    high = vec(highs[0], highs[1], highs[2]);
  }
};

/** Boxes by the buckets of a regular grid that they cover, as one compressed
    list. */
class BoxBuckets
{
public:
  /** @p boxes: of the items; @p size: of a bucket, made larger where boxes are
      far between. */
  BoxBuckets(const std::vector<Box> &boxes, double size)
  {
    Box all;
    for (const Box &box : boxes)
    {
      all.add(box.low);
      all.add(box.high);
    }
    low = all.low;
    if (boxes.empty())
      return;
    const double most = 20. * boxes.size() + 1000.;
    for (;; size *= 1.3)
    {
      double total = 1.;
      for (int d = 0; d < 3; ++d)
      {
        const double cells = std::floor((all.high[d] - low[d]) / size) + 1.;
        total *= cells;
        n[d] = std::int64_t(std::min(cells, 1e9));
      }
      if (total <= most)
        break;
    }
    scale = 1. / size;
    start.assign(n[0] * n[1] * n[2] + 1, 0);
    for (const Box &box : boxes)
      for_all(box, [&](const std::int64_t bucket) { ++start[bucket + 1]; });
    for (std::size_t k = 1; k < start.size(); ++k)
      start[k] += start[k - 1];
    items.resize(start.back());
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    for (std::size_t item = 0; item < boxes.size(); ++item)
      for_all(boxes[item],
              [&](const std::int64_t bucket) { items[next[bucket]++] = item; });
  }
  /** Items whose box may contain @p x, ascending. */
  std::pair<const std::int32_t *, const std::int32_t *> find(const Vec x) const
  {
    std::array<std::int64_t, 3> i;
    for (int d = 0; d < 3; ++d)
    {
      const double cell = std::floor((x[d] - low[d]) * scale);
      if (!(cell >= 0. && cell < double(n[d])))
        return {nullptr, nullptr};
      i[d] = std::int64_t(cell);
    }
    const std::int64_t bucket = (i[2] * n[1] + i[1]) * n[0] + i[0];
    return {items.data() + start[bucket], items.data() + start[bucket + 1]};
  }

private:
  template <typename Action>
  void for_all(const Box &box, const Action &action) const
  {
    std::array<std::int64_t, 3> a, b;
    for (int d = 0; d < 3; ++d)
    {
      a[d] = std::int64_t((box.low[d] - low[d]) * scale);
      b[d] = std::min(std::int64_t((box.high[d] - low[d]) * scale), n[d] - 1);
    }
    for (std::int64_t k = a[2]; k <= b[2]; ++k)
      for (std::int64_t j = a[1]; j <= b[1]; ++j)
        for (std::int64_t i = a[0]; i <= b[0]; ++i)
          action((k * n[1] + j) * n[0] + i);
  }
  Vec low;
  double scale = 0.;
  std::array<std::int64_t, 3> n{{0, 0, 0}};
  std::vector<std::int32_t> start, items;
};
} // namespace sabot

#endif
