// Search for new neighbors among all particles of the body.
#include "sabot/bodies/spg/neighbor_search.h"

#include "sabot/base/gather_all.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/mirror_planes.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/kernels/mirrored.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** What every rank learns of every particle; plain bytes for MPI. */
struct Item
{
  GlobalIndex id;
  std::int32_t is_damaged, planes;  // MirrorPlanes::planes_at()
  double position[3], to_kernel[9]; // x, H^-1
};

std::vector<Item> gather_items(const SpgParts &body, MPI_Comm communicator)
{
  const NodalState &nodes = body.nodes;
  const std::size_t n = nodes.n_owned;
  std::vector<Item> mine(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    mine[i].id = nodes.global_id[i];
    mine[i].is_damaged = body.failure.n_failed[i] > 0;
    mine[i].planes = body.mirror.planes_at(nodes.reference_position[i]);
    const Mat inverse_kernel = inverse(body.fields.kernel[i]);
    for (int d = 0; d < 3; ++d)
    {
      mine[i].position[d] = nodes.position[i][d];
      for (int e = 0; e < 3; ++e)
        mine[i].to_kernel[3 * d + e] = inverse_kernel(d, e);
    }
  }
  std::vector<Item> all = gather_all(mine, communicator);
  std::sort(all.begin(), all.end(),
            [](const Item &a, const Item &b) { return a.id < b.id; });
  return all;
}

/** Add images, behind the particles and by number, that may be closer than
    @p reach [m] to any. */
void add_images(const MirrorPlanes &mirror, const double reach,
                std::vector<Item> &all)
{
  const std::size_t n = all.size();
  for (std::size_t i = 0; i < n && mirror.any(); ++i)
  {
    const Vec x =
        vec(all[i].position[0], all[i].position[1], all[i].position[2]);
    mirror.for_images(x, all[i].planes, reach,
                      [&](const unsigned int symmetry, const Vec there)
                      {
                        Item image = all[i];
                        image.id = MirrorPlanes::image(all[i].id, symmetry);
                        const Vec signs =
                            mirror_signs(mirror.turned_axes(symmetry));
                        for (int d = 0; d < 3; ++d)
                        {
                          image.position[d] = there[d];
                          for (int e = 0; e < 3; ++e)
                            image.to_kernel[3 * d + e] *= signs[d] * signs[e];
                        }
                        all.push_back(image);
                      });
  }
  std::sort(all.begin() + n, all.end(),
            [](const Item &a, const Item &b) { return a.id < b.id; });
}

bool is_in_kernel(const Item &center, const Vec dX, const bool cubic)
{
  double square = 0., largest = 0.;
  for (int d = 0; d < 3; ++d)
  {
    const double *const row = &center.to_kernel[3 * d];
    const double xi = row[0] * dX[0] + row[1] * dX[1] + row[2] * dX[2];
    square += xi * xi;
    largest = std::max(largest, xi * xi);
  }
  return (cubic ? largest : square) < 1. - 1e-9;
}

/** Longest semi-axis of any kernel [m]. Collective. */
double kernel_reach(const NodalState &nodes, const ParticleFields &fields,
                    MPI_Comm communicator)
{
  double reach = 0.;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const Mat &H = fields.kernel[i];
    reach = std::max({reach, norm(H.row[0]), norm(H.row[1]), norm(H.row[2])});
  }
  MPI_Allreduce(MPI_IN_PLACE, &reach, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return reach;
}
} // namespace

BondList::Rows search_neighbors(const SpgParts &body, MPI_Comm communicator)
{
  const SpgOptions &options = body.options;
  const NodalState &nodes = body.nodes;
  const BondList &bonds = body.bonds;
  const BondFailure &failure = body.failure;
  const std::size_t n = nodes.n_owned;
  std::vector<Item> all = gather_items(body, communicator);
  const double reach = kernel_reach(nodes, body.fields, communicator);
  add_images(body.mirror, reach, all);
  std::vector<std::array<double, 3>> points;
  points.reserve(all.size());
  for (const Item &item : all)
    points.push_back({{item.position[0], item.position[1], item.position[2]}});
  const std::vector<GlobalIndex> owned(nodes.global_id.begin(),
                                       nodes.global_id.begin() + n);
  const BondList::Rows candidates =
      BondList::rows_within(points, {{1., 1., 1.}}, reach, true, owned);
  const bool cubic = options.has_tensor_kernel(),
             keeps_bonds = options.neighbor_policy ==
                           SpgOptions::NeighborPolicy::search_undamaged;
  BondList::Rows rows;
  for (std::size_t i = 0; i < n; ++i)
  {
    if (keeps_bonds)
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        rows.add(nodes.global_id[bonds.neighbor[b]]);
    for (const GlobalIndex j : candidates[i])
    {
      const Item &there = all[j];
      const Vec dX =
          vec(there.position[0], there.position[1], there.position[2]) -
          nodes.position[i];
      if (!is_in_kernel(all[owned[i]], dX, cubic) &&
          !is_in_kernel(there, dX, cubic))
        continue;
      const auto has_failed = [&]
      {
        const std::vector<GlobalIndex> &pairs = failure.failed_pairs[i];
        return std::find(pairs.begin(), pairs.end(), there.id) != pairs.end();
      };
      if (keeps_bonds ? failure.n_failed[i] == 0 && !there.is_damaged
                      : !has_failed())
        rows.add(there.id);
    }
    rows.sort_and_end_row();
  }
  return rows;
}
} // namespace sabot
