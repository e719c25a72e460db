// Boxes, and a grid of buckets that finds those around a point.
#include "sabot/couplings/box_buckets.h"

#include <cmath>

namespace sabot
{
double Box::distance(const Box &o) const
{
  double d = -1e300;
  for (int c = 0; c < 3; ++c)
    d = std::max({d, low[c] - o.high[c], o.low[c] - high[c]});
  return d;
}

bool Box::meets(const Box &o) const
{
  for (int d = 0; d < 3; ++d)
    if (!(o.high[d] >= low[d] && o.low[d] <= high[d]))
      return false;
  return true;
}

void Box::reduce(MPI_Comm communicator)
{
  double lows[3] = {low[0], low[1], low[2]},
         highs[3] = {high[0], high[1], high[2]};
  MPI_Allreduce(MPI_IN_PLACE, lows, 3, MPI_DOUBLE, MPI_MIN, communicator);
  MPI_Allreduce(MPI_IN_PLACE, highs, 3, MPI_DOUBLE, MPI_MAX, communicator);
  low = vec(lows[0], lows[1], lows[2]);
  high = vec(highs[0], highs[1], highs[2]);
}

template <typename Action>
void BoxBuckets::for_all(const Box &box, const Action &action) const
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

std::vector<Box> boxes_of_ranks(const Box &mine, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<Box> all(n_ranks);
  MPI_Allgather(&mine, sizeof(Box), MPI_BYTE, all.data(), sizeof(Box), MPI_BYTE,
                communicator);
  return all;
}

BoxBuckets::BoxBuckets(const std::vector<Box> &boxes, double size)
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

std::pair<const std::int32_t *, const std::int32_t *>
BoxBuckets::find(const Vec x) const
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
} // namespace sabot
