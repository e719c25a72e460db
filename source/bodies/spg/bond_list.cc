// Neighbors of particles: search, compressed list, removal, ghosts' bonds.
#include "sabot/bodies/spg/bond_list.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace sabot
{
namespace
{
/** Points sorted into buckets of one reach, in units of a spacing per axis. */
class Buckets
{
public:
  Buckets(const std::vector<std::array<double, 3>> &points,
          const std::array<double, 3> &spacing, const double reach)
      : points(points), spacing(spacing), reach(reach)
  {
    std::array<double, 3> high{{-1e300, -1e300, -1e300}};
    for (const auto &p : points)
      for (int d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], p[d] / spacing[d]);
        high[d] = std::max(high[d], p[d] / spacing[d]);
      }
    for (int d = 0; d < 3; ++d)
      n_buckets[d] = static_cast<std::size_t>((high[d] - low[d]) / reach) + 1;
    contents.resize(n_buckets[0] * n_buckets[1] * n_buckets[2]);
    for (std::size_t i = 0; i < points.size(); ++i)
      contents[index(at(i, 0), at(i, 1), at(i, 2))].push_back(i);
  }

  /** Call @p visit for the other points in the buckets around point @p i. */
  template <typename Visit>
  void around(const GlobalIndex i, const Visit &visit) const
  {
    std::array<std::size_t, 3> first, last;
    for (int d = 0; d < 3; ++d)
    {
      const std::size_t b = at(i, d);
      first[d] = b > 0 ? b - 1 : 0;
      last[d] = std::min(b + 1, n_buckets[d] - 1);
    }
    for (std::size_t z = first[2]; z <= last[2]; ++z)
      for (std::size_t y = first[1]; y <= last[1]; ++y)
        for (std::size_t x = first[0]; x <= last[0]; ++x)
          for (const GlobalIndex j : contents[index(x, y, z)])
            if (j != i)
              visit(j);
  }

private:
  std::size_t at(const std::size_t i, const int d) const
  {
    return std::min(
        n_buckets[d] - 1,
        static_cast<std::size_t>((points[i][d] / spacing[d] - low[d]) / reach));
  }
  std::size_t index(const std::size_t x, const std::size_t y,
                    const std::size_t z) const
  {
    return x + n_buckets[0] * (y + n_buckets[1] * z);
  }

  const std::vector<std::array<double, 3>> &points;
  const std::array<double, 3> spacing;
  const double reach;
  std::array<double, 3> low{{1e300, 1e300, 1e300}};
  std::array<std::size_t, 3> n_buckets;
  std::vector<std::vector<GlobalIndex>> contents;
};

[[noreturn]] void
fail_coincident(const std::vector<std::array<double, 3>> &points,
                const GlobalIndex i, const GlobalIndex j)
{
  char where[80];
  std::snprintf(where, sizeof(where), "(%.6g, %.6g, %.6g) m", points[i][0],
                points[i][1], points[i][2]);
  throw std::invalid_argument("particles " + std::to_string(std::min(i, j)) +
                              " and " + std::to_string(std::max(i, j)) +
                              " coincide at " + where +
                              "; every particle needs a place of its own");
}
} // namespace

BondList::Rows
BondList::rows_within(const std::vector<std::array<double, 3>> &points,
                      const std::array<double, 3> &spacing,
                      const double support, const bool cubic,
                      const std::vector<GlobalIndex> &owned_ids)
{
  const Buckets buckets(points, spacing, support);
  // A neighbor exactly at the support's edge has no weight.
  const double reach = support * (1. - 1e-9);
  Rows rows(owned_ids.size());
  for (std::size_t row = 0; row < owned_ids.size(); ++row)
  {
    const GlobalIndex i = owned_ids[row];
    buckets.around(i,
                   [&](const GlobalIndex j)
                   {
                     double r2 = 0., largest = 0.;
                     for (int d = 0; d < 3; ++d)
                     {
                       const double s =
                           (points[j][d] - points[i][d]) / spacing[d];
                       r2 += s * s;
                       largest = std::max(largest, s * s);
                     }
                     if (r2 < 1e-12)
                       fail_coincident(points, i, j);
                     if ((cubic ? largest : r2) < reach * reach)
                       rows[row].push_back(j);
                   });
    std::sort(rows[row].begin(), rows[row].end());
  }
  return rows;
}

BondList::Rows
BondList::rows_in_kernels(const std::vector<std::array<double, 3>> &points,
                          const AlignedVector<Mat> &kernel, const bool cubic,
                          const std::vector<GlobalIndex> &owned_ids)
{
  const bool one_for_all = kernel.size() == 1;
  AlignedVector<Mat> to_kernel;
  std::array<double, 3> extent{{0., 0., 0.}};
  for (const Mat &H : kernel)
  {
    to_kernel.push_back(inverse(H));
    // Half the bounding box of the mapped ball, or cube.
    for (int d = 0; d < 3; ++d)
      extent[d] = std::max(extent[d], cubic ? std::abs(H.row[d][0]) +
                                                  std::abs(H.row[d][1]) +
                                                  std::abs(H.row[d][2])
                                            : norm(H.row[d]));
  }
  const auto distance = [&](const std::size_t center, const Vec dX)
  {
    const Vec xi = to_kernel[one_for_all ? 0 : center] * dX;
    return cubic ? std::max({std::abs(xi[0]), std::abs(xi[1]), std::abs(xi[2])})
                 : norm(xi);
  };
  // A neighbor exactly at the kernel's edge has no weight.
  constexpr double edge = 1. - 1e-9, coincident = 5e-7;
  Rows rows(owned_ids.size());
  const Buckets buckets(points, extent, 1.);
  for (std::size_t row = 0; row < owned_ids.size(); ++row)
  {
    const GlobalIndex i = owned_ids[row];
    buckets.around(i,
                   [&](const GlobalIndex j)
                   {
                     const Vec dX = vec(points[j][0] - points[i][0],
                                        points[j][1] - points[i][1],
                                        points[j][2] - points[i][2]);
                     const double there = distance(i, dX),
                                  back = one_for_all ? there : distance(j, dX);
                     if (std::min(there, back) < coincident)
                       fail_coincident(points, i, j);
                     if (std::min(there, back) < edge)
                       rows[row].push_back(j);
                   });
    std::sort(rows[row].begin(), rows[row].end());
  }
  return rows;
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
  std::vector<std::uint32_t> new_count;
  AlignedVector<std::uint32_t> new_neighbor;
  std::vector<std::uint32_t> new_origin;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    // Both the old and the new row ascend.
    const bool is_old = i < n_owned; // bodies may grow
    std::size_t old = is_old ? begin(i) : 0;
    const std::size_t last = is_old ? end(i) : 0;
    for (const GlobalIndex j : rows[i])
    {
      while (old < last && id[neighbor[old]] < j)
        ++old;
      const bool kept = old < last && id[neighbor[old]] == j;
      new_origin.push_back(kept ? old : is_new);
      new_neighbor.push_back(local.at(j));
    }
    new_neighbor.resize(packed(new_neighbor.size()), i);
    new_origin.resize(new_neighbor.size(), is_new);
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
  origin.swap(new_origin);
  weight.assign(neighbor.size(), 0.f);
  scaled_weight.assign(neighbor.size(), 0.f);
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
  reverse.assign(neighbor.size() + look_ahead, 0u);
  std::iota(reverse.begin(), reverse.begin() + neighbor.size(), 0u);
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
}

bool BondList::remove(const std::vector<char> &dead)
{
  int has_changed = 0;
  origin.resize(neighbor.size());
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    std::size_t to = begin(i);
    const std::size_t last = end(i);
    for (std::size_t from = begin(i); from < last; ++from)
    {
      if (dead[from])
      {
        has_changed = 1;
        continue;
      }
      origin[to] = from;
      if (to != from)
      {
        neighbor[to] = neighbor[from];
        reverse[to] = reverse[from];
        weight[to] = weight[from];
        scaled_weight[to] = scaled_weight[from];
        if (neighbor[to] < n_owned)
          reverse[reverse[to]] = to;
      }
      ++to;
    }
    count[i] = to - begin(i);
    for (; to < last; ++to)
    {
      neighbor[to] = i;
      reverse[to] = to;
      weight[to] = scaled_weight[to] = 0.f;
    }
  }
  // Bonds that go or move at a rank's border change what is exchanged.
  MPI_Allreduce(MPI_IN_PLACE, &has_changed, 1, MPI_INT, MPI_MAX, communicator);
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks > 1 && has_changed)
    reconnect();
  return has_changed != 0;
}
} // namespace sabot
