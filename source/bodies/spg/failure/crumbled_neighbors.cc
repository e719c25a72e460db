// Neighbors of metal that has crumbled: those that are near now.
#include "sabot/bodies/spg/failure/crumbled_neighbors.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/kernels/point_buckets.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Plain bytes for MPI. */
struct Crumb
{
  GlobalIndex id;
  Vec x; // now [m]
};

/** Those of all ranks, by number. */
AlignedVector<Crumb> gather_crumbs(const NodalState &nodes,
                                   const BondFailure &failure,
                                   MPI_Comm communicator)
{
  AlignedVector<Crumb> mine;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (failure.has_crumbled(i))
      mine.push_back({nodes.global_id[i], nodes.position[i]});
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<int> counts(n_ranks), starts(n_ranks, 0);
  const int bytes = mine.size() * sizeof(Crumb);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  for (int r = 1; r < n_ranks; ++r)
    starts[r] = starts[r - 1] + counts[r - 1];
  AlignedVector<Crumb> all((starts.back() + counts.back()) / sizeof(Crumb));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(),
                 starts.data(), MPI_BYTE, communicator);
  std::sort(all.begin(), all.end(),
            [](const Crumb &a, const Crumb &b) { return a.id < b.id; });
  return all;
}
} // namespace

BondList::Rows renew_crumbled_neighbors(const NodalState &nodes,
                                        const BondList &bonds,
                                        const BondFailure &failure,
                                        const LagrangianKernel &kernel,
                                        MPI_Comm communicator)
{
  const AlignedVector<Crumb> all = gather_crumbs(nodes, failure, communicator);
  const double reach = kernel.support() * kernel.mean_spacing();
  PointBuckets buckets(reach);
  for (std::size_t k = 0; k < all.size(); ++k)
    buckets.add(all[k].x, k);
  BondList::Rows rows(nodes.n_owned);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      if (failure.is_cohesive(i, bonds.neighbor[b]))
        rows[i].push_back(nodes.global_id[bonds.neighbor[b]]);
    if (!failure.has_crumbled(i))
      continue;
    const Vec x = nodes.position[i];
    buckets.for_near(x,
                     [&](const std::size_t k)
                     {
                       if (all[k].id != nodes.global_id[i] &&
                           norm_square(all[k].x - x) < reach * reach)
                         rows[i].push_back(all[k].id);
                     });
    std::sort(rows[i].begin(), rows[i].end());
  }
  return rows;
}
} // namespace sabot
