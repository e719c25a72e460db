// Stress and volume ratio where the shares of cells lie.
#include "sabot/bodies/fem/corner_fields.h"

#include "sabot/kernels/stress_update.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** In VTK order: bit d says whether the corner lies at the upper end of axis
    d of the cell. */
constexpr int side[8] = {0, 1, 3, 2, 4, 5, 7, 6};
} // namespace

CornerFields::Values CornerFields::values_of(const Hexahedra &cells,
                                             const std::size_t e)
{
  Values values{{cells.volume_ratio(e)}};
  for (std::size_t c = 0; c < n_symmetric; ++c)
    values[1 + c] = cells.stress(c, e);
  return values;
}

void CornerFields::Around::add(const Values &values, const double V_0)
{
  for (int k = 0; k < n; ++k)
  {
    mean[k] += V_0 * values[k];
    least[k] = volume > 0. ? std::min(least[k], values[k]) : values[k];
    largest[k] = volume > 0. ? std::max(largest[k], values[k]) : values[k];
  }
  volume += V_0;
  mises = std::max(mises, von_mises(&values[1]));
}

CornerFields::CornerFields(const Hexahedra &cells, const NodalState &nodes,
                           const GhostExchange &exchange,
                           const std::vector<std::size_t> &leaving,
                           const std::vector<NodalMatter::Entry> &particles)
    : cells(cells), around(nodes.size())
{
  std::vector<char> is_asked(nodes.size(), 0);
  for (const std::size_t e : leaving)
    for (const std::uint32_t a : cells.connectivity[e])
      is_asked[a] = 1;
  for (std::size_t e = 0; e < cells.size(); ++e) // in their order
  {
    const auto &corners = cells.connectivity[e];
    if (std::none_of(corners.begin(), corners.end(),
                     [&](const std::uint32_t a) { return is_asked[a] != 0; }))
      continue;
    const Values values = values_of(cells, e);
    for (const std::uint32_t a : corners)
      around[a].add(values, cells.volume[e]);
  }
  for (const NodalMatter::Entry &particle : particles)
  {
    if (!is_asked[particle.node])
      continue;
    Values values{{particle.volume / particle.reference_volume}};
    std::copy(particle.stress.begin(), particle.stress.end(),
              values.begin() + 1);
    around[particle.node].add(values, particle.reference_volume);
  }
  for (Around &node : around)
    for (double &mean : node.mean)
      mean /= std::max(node.volume, 1e-300);
  exchange.update(around.data()); // a ghost may lack cells here
}

void CornerFields::move_to(const std::size_t e,
                           const std::array<double, 3> &middle,
                           NodalMatter::Entry &share) const
{
  Values change{};
  for (int b = 0; b < 8; ++b)
  {
    double w = 1.;
    for (int d = 0; d < 3; ++d)
      w *= 0.5 * (side[b] >> d & 1 ? 1. + middle[d] : 1. - middle[d]);
    w -= 0.125;
    const Values &mean = around[cells.connectivity[e][b]].mean;
    for (int k = 0; k < n; ++k)
      change[k] += w * mean[k];
  }
  share.volume += change[0] * share.reference_volume;
  for (std::size_t c = 0; c < n_symmetric; ++c)
    share.stress[c] += change[1 + c];
}

void CornerFields::bound(const std::vector<std::size_t> &nodes,
                         NodalMatter::Entry &entry) const
{
  Around node = around[nodes[0]];
  for (const std::size_t a : nodes)
  {
    for (int k = 0; k < n; ++k)
    {
      node.least[k] = std::min(node.least[k], around[a].least[k]);
      node.largest[k] = std::max(node.largest[k], around[a].largest[k]);
    }
    node.mises = std::max(node.mises, around[a].mises);
  }
  const double V_0 = entry.reference_volume;
  entry.volume =
      std::clamp(entry.volume, V_0 * node.least[0], V_0 * node.largest[0]);
  for (std::size_t c = 0; c < n_symmetric; ++c)
    entry.stress[c] =
        std::clamp(entry.stress[c], node.least[1 + c], node.largest[1 + c]);
  const double size = von_mises(entry.stress.data());
  if (size <= node.mises)
    return;
  const double mean =
                   (entry.stress[0] + entry.stress[1] + entry.stress[2]) / 3.,
               factor = node.mises / size;
  for (std::size_t c = 0; c < n_symmetric; ++c)
  {
    const double pressure = c < 3 ? mean : 0.;
    entry.stress[c] = pressure + factor * (entry.stress[c] - pressure);
  }
}
} // namespace sabot
