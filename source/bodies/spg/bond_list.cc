// Neighbors of particles: search, compressed list, removal, ghosts' bonds.
#include "sabot/bodies/spg/bond_list.h"

#include "sabot/bodies/spg/mirror_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

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
  Rows rows;
  for (const GlobalIndex i : owned_ids)
  {
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
                       rows.add(j);
                   });
    rows.sort_and_end_row();
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
  Rows rows;
  const Buckets buckets(points, extent, 1.);
  for (const GlobalIndex i : owned_ids)
  {
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
                       rows.add(j);
                   });
    rows.sort_and_end_row();
  }
  return rows;
}

std::vector<GlobalIndex>
BondList::ghosts_of(const Rows &rows, const std::vector<GlobalIndex> &owned_ids)
{
  const NumberIndex place(owned_ids.data(), owned_ids.size());
  std::vector<GlobalIndex> ghosts;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const GlobalIndex j : rows[i])
      if (place(j) == owned_ids.size())
        ghosts.push_back(j);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  return ghosts;
}

void BondList::reflect_in(const MirrorPlanes &planes,
                          std::vector<std::uint8_t> its_planes)
{
  mirror = &planes;
  on_planes = std::move(its_planes);
}

void BondList::connect(Rows rows, const std::vector<GlobalIndex> &global_id,
                       const std::vector<int> &ghost_owner,
                       const GlobalIndex n_global, MPI_Comm comm)
{
  // What is found anew does not wait beside old and new rows.
  AlignedVector<float>().swap(weight);
  AlignedVector<float>().swap(scaled_weight);
  std::vector<std::uint32_t>().swap(reverse);
  const std::size_t n_rows = rows.size();
  const bool is_first = neighbor.empty();
  const NumberIndex of_owned(global_id.data(), n_rows),
      of_ghost(global_id.data() + n_rows, global_id.size() - n_rows);
  std::vector<std::size_t> new_start(n_rows + 1, 0);
  for (std::size_t i = 0; i < n_rows; ++i)
    new_start[i + 1] = new_start[i] + packed(rows[i].size());
  std::vector<std::uint32_t> new_count(n_rows),
      new_origin(is_first ? 0 : new_start[n_rows], is_new);
  AlignedVector<std::uint32_t> new_neighbor(new_start[n_rows]);
  for (std::size_t i = 0; i < n_rows; ++i)
  {
    // Both the old and the new row ascend.
    const bool is_old = i < n_owned; // bodies may grow
    std::size_t old = is_old ? begin(i) : 0;
    const std::size_t last = is_old ? end(i) : 0;
    std::size_t bond = new_start[i];
    for (const GlobalIndex j : rows[i])
    {
      while (old < last && id[neighbor[old]] < j)
        ++old;
      if (old < last && id[neighbor[old]] == j)
        new_origin[bond] = old;
      const std::size_t place = of_owned(j);
      new_neighbor[bond] = place < n_rows ? place : n_rows + of_ghost(j);
      ++bond;
    }
    new_count[i] = rows[i].size();
    for (; bond < new_start[i + 1]; ++bond)
      new_neighbor[bond] = i;
  }
  rows = Rows();
  ++changes;
  communicator = comm;
  id = global_id;
  owner_of_ghost = ghost_owner;
  n_total = n_global;
  n_owned = n_rows;
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
  const std::size_t b = first_from(i, neighbor_id);
  if (b == end(i) || id[neighbor[b]] != neighbor_id)
    throw std::logic_error("a bond is missing at one of its ends");
  return b;
}

void BondList::reverse_owned()
{
  // Rows ascend, and so do the particles that are asked in turn: each row is
  // met from its begin to its end.
  std::vector<std::size_t> next(row_start.begin(), row_start.end() - 1);
  const auto skip_ghosts = [&](const std::size_t j)
  {
    while (next[j] < end(j) && neighbor[next[j]] >= n_owned)
      ++next[j];
  };
  const auto fail = []
  { throw std::logic_error("a bond is missing at one of its ends"); };
  for (std::size_t i = 0; i < n_owned; ++i)
    for (std::size_t b = begin(i); b < end(i); ++b)
    {
      const std::uint32_t j = neighbor[b];
      if (j >= n_owned)
        continue;
      skip_ghosts(j);
      if (next[j] == end(j) || neighbor[next[j]] != i)
        fail();
      reverse[b] = next[j]++;
    }
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    skip_ghosts(i);
    if (next[i] != end(i))
      fail();
  }
}

void BondList::reconnect()
{
  reverse.assign(neighbor.size() + look_ahead, 0u);
  std::iota(reverse.begin(), reverse.begin() + neighbor.size(), 0u);
  reverse_owned();
  at_ghosts.clear();
  for (std::size_t i = 0; i < n_owned && !owner_of_ghost.empty(); ++i)
    if (std::any_of(neighbor.begin() + begin(i), neighbor.begin() + end(i),
                    [this](const std::uint32_t j) { return j >= n_owned; }))
      at_ghosts.push_back(i);
  connect_ghosts();
}

std::vector<BondList::Ghost> BondList::ghosts_and_images() const
{
  std::vector<Ghost> ghosts;
  ghosts.reserve(owner_of_ghost.size());
  for (std::size_t g = 0; g < owner_of_ghost.size(); ++g)
  {
    const GlobalIndex number = id[n_owned + g];
    const unsigned int symmetry = MirrorPlanes::symmetry_of(number);
    ghosts.push_back({MirrorPlanes::particle_of(number),
                      symmetry == 0 ? 0 : mirror->inverse(symmetry),
                      symmetry == 0 ? 0 : mirror->turned_axes(symmetry)});
  }
  return ghosts;
}

void BondList::connect_ghosts()
{
  const std::vector<Ghost> ghosts = ghosts_and_images();
  std::vector<int> owners;
  std::vector<GlobalIndex> keys;
  std::vector<MirroredExchange::Turned> turned;
  for (const std::uint32_t i : at_ghosts)
    for (std::size_t b = begin(i); b < end(i); ++b)
    {
      if (neighbor[b] < n_owned)
        continue;
      const std::size_t g = neighbor[b] - n_owned;
      const Ghost &ghost = ghosts[g];
      reverse[b] = neighbor.size() + owners.size();
      if (ghost.turned_axes != 0)
        turned.emplace_back(owners.size(), ghost.turned_axes);
      owners.push_back(owner_of_ghost[g]);
      // Packed: there, seen from there, image.
      const GlobalIndex image_here =
          ghost.back == 0 ? 0 : mirror->canonical(ghost.back, on_planes[i]);
      keys.push_back((image_here * n_total + id[i]) * n_total + ghost.particle);
    }
  const NumberIndex place(id.data(), n_owned);
  exchange = MirroredExchange(
      GhostExchange(communicator, neighbor.size(), owners, keys,
                    [&](const GlobalIndex key)
                    {
                      const GlobalIndex other = key / n_total;
                      return find(place(key % n_total),
                                  MirrorPlanes::image(other % n_total,
                                                      other / n_total));
                    }),
      neighbor.size(), std::move(turned));
}

bool BondList::remove_from_row(const std::size_t i,
                               const std::vector<char> &dead)
{
  std::size_t to = begin(i);
  const std::size_t last = end(i);
  for (std::size_t from = begin(i); from < last; ++from)
  {
    if (dead[from])
      continue;
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
  const bool has_changed = to < last;
  for (; to < last; ++to)
  {
    neighbor[to] = i;
    reverse[to] = to;
    weight[to] = scaled_weight[to] = 0.f;
  }
  return has_changed;
}

bool BondList::remove(const std::vector<char> &dead)
{
  bool has_changed = false;
  origin.resize(neighbor.size());
  for (std::size_t i = 0; i < n_owned; ++i)
    has_changed |= remove_from_row(i, dead);
  return settle_removal(has_changed);
}

bool BondList::remove(const std::vector<char> &dead,
                      const std::vector<std::uint32_t> &rows)
{
  bool has_changed = false;
  origin.resize(neighbor.size());
  for (const std::uint32_t i : rows)
    has_changed |= remove_from_row(i, dead);
  return settle_removal(has_changed);
}

bool BondList::settle_removal(int has_changed)
{
  // Bonds that go or move at a rank's border change what is exchanged.
  MPI_Allreduce(MPI_IN_PLACE, &has_changed, 1, MPI_INT, MPI_MAX, communicator);
  changes += has_changed;
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if ((n_ranks > 1 || mirror != nullptr) && has_changed)
    connect_ghosts(); // rows have kept the other ends of their own
  return has_changed != 0;
}
} // namespace sabot
