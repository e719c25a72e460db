#include "sabot/geometry/particle_cloud.h"

#include <deal.II/base/point.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sabot
{
unsigned int n_intervals(const double length, const double spacing)
{
  return std::max(1u, static_cast<unsigned int>(std::lround(length / spacing)));
}

ParticleCloud make_box_cloud(const std::array<double, 3> &centre,
                             const std::array<double, 3> &size,
                             const double nodal_spacing)
{
  return make_box_cloud(centre, size,
                        {{nodal_spacing, nodal_spacing, nodal_spacing}});
}

ParticleCloud make_box_cloud(const std::array<double, 3> &centre,
                             const std::array<double, 3> &size,
                             const std::array<double, 3> &nodal_spacing)
{
  ParticleCloud cloud;
  std::array<unsigned int, 3> n;
  for (unsigned int d = 0; d < 3; ++d)
  {
    n[d] = n_intervals(size[d], nodal_spacing[d]);
    cloud.spacing[d] = size[d] / n[d];
  }

  std::vector<std::array<unsigned int, 3>> lattice;
  std::vector<dealii::Point<3>> points;
  for (unsigned int k = 0; k <= n[2]; ++k)
    for (unsigned int j = 0; j <= n[1]; ++j)
      for (unsigned int i = 0; i <= n[0]; ++i)
      {
        lattice.push_back({{i, j, k}});
        points.emplace_back(i, j, k);
      }
  const auto curve =
      dealii::Utilities::inverse_Hilbert_space_filling_curve(points, 10);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](const std::size_t a, const std::size_t b)
            { return curve[a] != curve[b] ? curve[a] < curve[b] : a < b; });

  for (const std::size_t p : order)
  {
    std::array<double, 3> x;
    double volume = 1.;
    std::uint32_t faces = 0;
    for (unsigned int d = 0; d < 3; ++d)
    {
      const unsigned int i = lattice[p][d];
      x[d] = centre[d] - 0.5 * size[d] + size[d] * i / n[d];
      const bool low = i == 0, high = i == n[d];
      volume *= cloud.spacing[d] * (low || high ? 0.5 : 1.);
      faces |= (low ? 1u : 0u) << (2 * d) | (high ? 1u : 0u) << (2 * d + 1);
    }
    cloud.position.push_back(x);
    cloud.volume.push_back(volume);
    cloud.on_face.push_back(faces);
  }
  return cloud;
}
} // namespace sabot
