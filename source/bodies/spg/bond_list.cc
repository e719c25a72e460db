#include "sabot/bodies/spg/bond_list.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace sabot
{
BondList::Rows
BondList::rows_within(const std::vector<std::array<double, 3>> &points,
                      const std::array<double, 3> &spacing,
                      const double support, const bool cubic,
                      const std::vector<GlobalIndex> &owned_ids)
{
  // Buckets of one support, in scaled coordinates.
  const std::size_t n = points.size();
  std::array<double, 3> low{{1e300, 1e300, 1e300}},
      high{{-1e300, -1e300, -1e300}};
  for (const auto &p : points)
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], p[d] / spacing[d]);
      high[d] = std::max(high[d], p[d] / spacing[d]);
    }
  std::array<std::size_t, 3> n_buckets;
  for (int d = 0; d < 3; ++d)
    n_buckets[d] = static_cast<std::size_t>((high[d] - low[d]) / support) + 1;
  const auto bucket_of = [&](const std::array<double, 3> &p, const int d)
  {
    return std::min(
        n_buckets[d] - 1,
        static_cast<std::size_t>((p[d] / spacing[d] - low[d]) / support));
  };
  std::vector<std::vector<GlobalIndex>> buckets(n_buckets[0] * n_buckets[1] *
                                                n_buckets[2]);
  for (std::size_t i = 0; i < n; ++i)
    buckets[bucket_of(points[i], 0) +
            n_buckets[0] * (bucket_of(points[i], 1) +
                            n_buckets[1] * bucket_of(points[i], 2))]
        .push_back(i);

  // A neighbour exactly at the support's edge has no weight.
  const double reach = support * (1. - 1e-9);
  Rows row_ids(owned_ids.size());
  for (std::size_t row = 0; row < owned_ids.size(); ++row)
  {
    const GlobalIndex i = owned_ids[row];
    std::array<std::size_t, 3> b, first, last;
    for (int d = 0; d < 3; ++d)
    {
      b[d] = bucket_of(points[i], d);
      first[d] = b[d] > 0 ? b[d] - 1 : 0;
      last[d] = std::min(b[d] + 1, n_buckets[d] - 1);
    }
    for (std::size_t z = first[2]; z <= last[2]; ++z)
      for (std::size_t y = first[1]; y <= last[1]; ++y)
        for (std::size_t x = first[0]; x <= last[0]; ++x)
          for (const GlobalIndex j :
               buckets[x + n_buckets[0] * (y + n_buckets[1] * z)])
          {
            if (j == i)
              continue;
            double r2 = 0., largest = 0.;
            for (int d = 0; d < 3; ++d)
            {
              const double s = (points[j][d] - points[i][d]) / spacing[d];
              r2 += s * s;
              largest = std::max(largest, s * s);
            }
            if (r2 < 1e-12)
              throw std::invalid_argument(
                  "particles " + std::to_string(std::min(i, j)) + " and " +
                  std::to_string(std::max(i, j)) + " coincide");
            if ((cubic ? largest : r2) < reach * reach)
              row_ids[row].push_back(j);
          }
    std::sort(row_ids[row].begin(), row_ids[row].end());
  }
  return row_ids;
}

std::vector<GlobalIndex>
BondList::ghosts_of(const Rows &rows, const std::vector<GlobalIndex> &owned_ids)
{
  std::vector<GlobalIndex> ghosts;
  for (const auto &row : rows)
    for (const GlobalIndex j : row)
      if (!std::binary_search(owned_ids.begin(), owned_ids.end(), j))
        ghosts.push_back(j);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  return ghosts;
}

void BondList::connect(const Rows &rows,
                       const std::vector<GlobalIndex> &global_id,
                       const std::vector<int> &ghost_owner,
                       const GlobalIndex n_global, MPI_Comm comm)
{
  std::unordered_map<GlobalIndex, std::uint32_t> local;
  local.reserve(global_id.size());
  for (std::size_t i = 0; i < global_id.size(); ++i)
    local[global_id[i]] = i;

  std::vector<std::size_t> new_start(1, 0);
  std::vector<std::uint32_t> new_count, new_neighbor;
  AlignedVector<StoredVec> new_residual;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    // Both the old and the new row ascend.
    std::size_t old = n_owned > 0 ? begin(i) : 0;
    const std::size_t last = n_owned > 0 ? end(i) : 0;
    for (const GlobalIndex j : rows[i])
    {
      while (old < last && id[neighbor[old]] < j)
        ++old;
      const bool kept = old < last && id[neighbor[old]] == j;
      new_residual.push_back(kept ? residual[old] : StoredVec{});
      new_neighbor.push_back(local.at(j));
    }
    new_start.push_back(new_neighbor.size());
    new_count.push_back(rows[i].size());
  }
  communicator = comm;
  id = global_id;
  owner_of_ghost = ghost_owner;
  n_total = n_global;
  n_owned = rows.size();
  row_start.swap(new_start);
  count.swap(new_count);
  neighbor.swap(new_neighbor);
  residual.swap(new_residual);
  weight.assign(neighbor.size(), 0.);
  reconnect();
}

std::size_t BondList::find(const std::size_t i,
                           const GlobalIndex neighbor_id) const
{
  for (std::size_t b = begin(i); b < end(i); ++b)
    if (id[neighbor[b]] == neighbor_id)
      return b;
  throw std::logic_error("a bond is missing at one of its ends");
}

void BondList::reconnect()
{
  reverse.assign(neighbor.size(), 0);
  std::vector<int> owners;
  std::vector<GlobalIndex> keys;
  for (std::size_t i = 0; i < n_owned; ++i)
    for (std::size_t b = begin(i); b < end(i); ++b)
    {
      const std::uint32_t j = neighbor[b];
      if (j < n_owned)
        reverse[b] = find(j, id[i]);
      else
      {
        reverse[b] = neighbor.size() + owners.size();
        owners.push_back(owner_of_ghost[j - n_owned]);
        keys.push_back(id[j] * n_total + id[i]);
      }
    }
  exchange =
      GhostExchange(communicator, neighbor.size(), owners, keys,
                    [&](const GlobalIndex key)
                    {
                      const auto i = std::lower_bound(
                          id.begin(), id.begin() + n_owned, key / n_total);
                      return find(i - id.begin(), key % n_total);
                    });
  residual.resize(neighbor.size() + owners.size());
}

std::size_t BondList::remove(const std::vector<char> &dead)
{
  std::size_t n_removed = 0;
  int across_ranks = 0;
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    std::size_t to = begin(i);
    const std::size_t last = end(i);
    for (std::size_t from = begin(i); from < last; ++from)
    {
      if (dead[from])
      {
        ++n_removed;
        continue;
      }
      if (to != from)
      {
        neighbor[to] = neighbor[from];
        reverse[to] = reverse[from];
        weight[to] = weight[from];
        residual[to] = residual[from];
        if (neighbor[to] < n_owned)
          reverse[reverse[to]] = to;
        else
          across_ranks = 1;
      }
      ++to;
    }
    if (to != last)
      count[i] = to - begin(i);
  }
  // Bonds that go or move at a rank's border change what is exchanged.
  across_ranks = across_ranks != 0 || n_removed > 0;
  MPI_Allreduce(MPI_IN_PLACE, &across_ranks, 1, MPI_INT, MPI_MAX, communicator);
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks > 1 && across_ranks)
    reconnect();
  return n_removed;
}
} // namespace sabot
