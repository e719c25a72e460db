#include "sabot/bodies/spg/spg_body.h"

#include <algorithm>

namespace sabot
{
void SpgBody::search_neighbors()
{
  // Every rank gets every particle: new neighbours may come from anywhere.
  struct Item
  {
    GlobalIndex id;
    GlobalIndex is_damaged;
    double position[3], to_kernel[9];
  };
  const std::size_t n = nodal_state.n_owned;
  std::vector<Item> mine(n), all(n_global);
  for (std::size_t i = 0; i < n; ++i)
  {
    mine[i].id = nodal_state.global_id[i];
    mine[i].is_damaged = n_failed[i] > 0;
    const Mat inverse_kernel = inverse(kernel[i]);
    for (int d = 0; d < 3; ++d)
    {
      mine[i].position[d] = nodal_state.position[i][d];
      for (int e = 0; e < 3; ++e)
        mine[i].to_kernel[3 * d + e] = inverse_kernel(d, e);
    }
  }
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<int> counts(n_ranks), starts(n_ranks, 0);
  const int bytes = n * sizeof(Item);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  for (int r = 1; r < n_ranks; ++r)
    starts[r] = starts[r - 1] + counts[r - 1];
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(),
                 starts.data(), MPI_BYTE, communicator);
  std::sort(all.begin(), all.end(),
            [](const Item &a, const Item &b) { return a.id < b.id; });

  double reach = 0.;
  for (std::size_t i = 0; i < n; ++i)
    reach = std::max({reach, norm(kernel[i].row[0]), norm(kernel[i].row[1]),
                      norm(kernel[i].row[2])});
  MPI_Allreduce(MPI_IN_PLACE, &reach, 1, MPI_DOUBLE, MPI_MAX, communicator);

  std::vector<std::array<double, 3>> points(n_global);
  for (GlobalIndex i = 0; i < n_global; ++i)
    points[i] = {{all[i].position[0], all[i].position[1], all[i].position[2]}};
  const std::vector<GlobalIndex> owned(nodal_state.global_id.begin(),
                                       nodal_state.global_id.begin() + n);
  const bool cubic = options.kernel_shape == SpgOptions::KernelShape::tensor;
  BondList::Rows candidates =
      BondList::rows_within(points, {{1., 1., 1.}}, reach, true, owned);
  const auto in_kernel = [&](const Item &centre, const Vec dX)
  {
    double square = 0., largest = 0.;
    for (int d = 0; d < 3; ++d)
    {
      const double *const row = &centre.to_kernel[3 * d];
      const double xi = row[0] * dX[0] + row[1] * dX[1] + row[2] * dX[2];
      square += xi * xi;
      largest = std::max(largest, xi * xi);
    }
    return (cubic ? largest : square) < 1. - 1e-9;
  };
  using Policy = SpgOptions::NeighborPolicy;
  BondList::Rows rows(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    std::vector<GlobalIndex> bonded;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      bonded.push_back(nodal_state.global_id[bonds.neighbor[b]]);
    if (options.neighbor_policy == Policy::search_undamaged)
      rows[i] = bonded;
    for (const GlobalIndex j : candidates[i])
    {
      const Item &there = all[j];
      const Vec dX =
          vec(there.position[0], there.position[1], there.position[2]) -
          nodal_state.position[i];
      if (!in_kernel(all[owned[i]], dX) && !in_kernel(there, dX))
        continue;
      if (options.neighbor_policy == Policy::search_undamaged)
      {
        if (n_failed[i] == 0 && !there.is_damaged)
          rows[i].push_back(j);
      }
      else if (std::find(failed_pairs[i].begin(), failed_pairs[i].end(), j) ==
               failed_pairs[i].end())
        rows[i].push_back(j);
    }
    std::sort(rows[i].begin(), rows[i].end());
    rows[i].erase(std::unique(rows[i].begin(), rows[i].end()), rows[i].end());
  }
  renumber(rows);
  node_exchange.update(kernel.data());
}
} // namespace sabot
