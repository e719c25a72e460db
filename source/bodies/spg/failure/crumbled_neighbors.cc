// Neighbors of metal that has crumbled: those that are near now.
#include "sabot/bodies/spg/failure/crumbled_neighbors.h"

#include "sabot/base/nodal_state.h"
#include "sabot/base/send_some.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/mirror_planes.h"
#include "sabot/kernels/sorted_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

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

/** The box around a rank's crumbs, with the reach around it [m]. */
struct CrumbBox
{
  double low[3], high[3];
  bool contains(const Vec x) const
  {
    bool inside = true;
    for (int d = 0; d < 3; ++d)
      inside = inside && low[d] <= x[d] && x[d] <= high[d];
    return inside;
  }
};

std::vector<CrumbBox> boxes_of_ranks(const std::vector<Crumb> &mine,
                                     const double reach, MPI_Comm communicator)
{
  CrumbBox box;
  for (int d = 0; d < 3; ++d)
  {
    box.low[d] = 1e300;
    box.high[d] = -1e300;
    for (const Crumb &crumb : mine)
    {
      box.low[d] = std::min(box.low[d], crumb.x[d] - reach);
      box.high[d] = std::max(box.high[d], crumb.x[d] + reach);
    }
  }
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<CrumbBox> boxes(n_ranks);
  MPI_Allgather(&box, 6, MPI_DOUBLE, boxes.data(), 6, MPI_DOUBLE, communicator);
  return boxes;
}

/** Images of the owned crumbs that may be closer than @p reach to any [m]. */
std::vector<Crumb> images_of_crumbs(const NodalState &nodes,
                                    const BondFailure &failure,
                                    const MirrorPlanes &mirror,
                                    const double reach)
{
  std::vector<Crumb> images;
  for (std::size_t i = 0; i < nodes.n_owned && mirror.any(); ++i)
    if (failure.has_crumbled(i))
      mirror.for_images(
          nodes.position[i], mirror.planes_at(nodes.reference_position[i]),
          reach,
          [&](const unsigned int symmetry, const Vec there)
          {
            images.push_back(
                {MirrorPlanes::image(nodes.global_id[i], symmetry), there});
          });
  return images;
}

/** This rank's and those of others, and images, that may be closer than @p
   reach [m] to one of them, by number. */
std::vector<Crumb> gather_crumbs(const NodalState &nodes,
                                 const BondFailure &failure,
                                 const MirrorPlanes &mirror, const double reach,
                                 MPI_Comm communicator)
{
  std::vector<Crumb> mine;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (failure.has_crumbled(i))
      mine.push_back({nodes.global_id[i], nodes.position[i]});
  const std::vector<Crumb> images =
      images_of_crumbs(nodes, failure, mirror, reach);
  int rank;
  MPI_Comm_rank(communicator, &rank);
  constexpr double round_off = 1. + 1e-9;
  const std::vector<CrumbBox> boxes =
      boxes_of_ranks(mine, round_off * reach, communicator);
  std::vector<std::vector<Crumb>> to_rank(boxes.size());
  for (std::size_t r = 0; r < boxes.size(); ++r)
  {
    const auto add_near = [&](const std::vector<Crumb> &crumbs)
    {
      std::copy_if(crumbs.begin(), crumbs.end(), std::back_inserter(to_rank[r]),
                   [&](const Crumb &crumb)
                   { return boxes[r].contains(crumb.x); });
    };
    if (int(r) == rank)
      to_rank[r] = mine;
    else
      add_near(mine);
    add_near(images);
  }
  std::vector<Crumb> near = send_some(to_rank, communicator);
  std::sort(near.begin(), near.end(),
            [](const Crumb &a, const Crumb &b) { return a.id < b.id; });
  return near;
}

/** Pairs of crumbs that are near each other, of this rank's ones. Row by row of
    the nodes, crumbs by number: where every crumb tells its neighbors of itself
    in the order of numbers, rows ascend without sorting. */
class NearCrumbs
{
public:
  NearCrumbs(const std::vector<Crumb> &all, const double reach,
             const NodalState &nodes)
      : start(nodes.n_owned + 1, 0)
  {
    constexpr std::uint32_t not_owned = 0xffffffffu;
    const NumberIndex place(nodes.global_id.data(), nodes.n_owned);
    std::vector<std::uint32_t> local(all.size(), not_owned);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
      const std::size_t i = place(all[k].id);
      if (i < nodes.n_owned)
        local[k] = i;
    }
    // By the neighbor: who has it. Then row by row.
    std::vector<std::size_t> begin_of(all.size() + 1, 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs; // row, neighbor
    SortedPoints(
        all.size(), [&](const std::size_t k) { return all[k].x; }, reach)
        .for_each([&](const std::uint32_t k) { return local[k] != not_owned; },
                  [&](const std::uint32_t k, const std::uint32_t *const near,
                      const std::size_t n)
                  {
                    for (std::size_t m = 0; m < n; ++m)
                      if (near[m] != k)
                      {
                        pairs.push_back({local[k], near[m]});
                        ++begin_of[near[m] + 1];
                        ++start[local[k] + 1];
                      }
                  });
    std::partial_sum(begin_of.begin(), begin_of.end(), begin_of.begin());
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> who(pairs.size());
    std::vector<std::size_t> next(begin_of.begin(), begin_of.end() - 1);
    for (const auto &[row, neighbor] : pairs)
      who[next[neighbor]++] = row;
    next.assign(start.begin(), start.end() - 1);
    numbers.resize(pairs.size());
    for (std::size_t k = 0; k < all.size(); ++k)
      for (std::size_t p = begin_of[k]; p < begin_of[k + 1]; ++p)
        numbers[next[who[p]]++] = all[k].id;
  }
  /** Global numbers of those near owned particle @p i, ascending. */
  const GlobalIndex *begin(const std::size_t i) const
  {
    return numbers.data() + start[i];
  }
  const GlobalIndex *end(const std::size_t i) const { return begin(i + 1); }

private:
  std::vector<std::size_t> start;
  std::vector<GlobalIndex> numbers;
};
} // namespace

BondList::Rows renew_crumbled_neighbors(const NodalState &nodes,
                                        const BondList &bonds,
                                        const BondFailure &failure,
                                        const LagrangianKernel &kernel,
                                        const MirrorPlanes &mirror,
                                        MPI_Comm communicator)
{
  // Both ends of a bond to an image agree on what is at the edge, too.
  constexpr double edge = 1. - 1e-9;
  const double reach = edge * kernel.support() * kernel.mean_spacing();
  const NearCrumbs near(
      gather_crumbs(nodes, failure, mirror, reach, communicator), reach, nodes);
  BondList::Rows rows;
  rows.reserve(nodes.n_owned, bonds.capacity());
  const std::vector<std::uint32_t> &marked = failure.marked_rows();
  auto with_marks = marked.begin();
  std::vector<GlobalIndex> kept;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const bool has_marks = with_marks != marked.end() && *with_marks == i;
    with_marks += has_marks;
    kept.clear();
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      if (!(has_marks && failure.has_failed_now(b)) &&
          failure.is_cohesive(i, bonds.neighbor[b]))
        kept.push_back(nodes.global_id[bonds.neighbor[b]]);
    rows.merge_and_end_row(kept, near.begin(i), near.end(i));
  }
  return rows;
}
} // namespace sabot
