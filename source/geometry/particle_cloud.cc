// Particles on the lattice of a box, and what faces do to particles.
#include "sabot/geometry/particle_cloud.h"

#include "sabot/geometry/item_count.h"

#include <deal.II/base/point.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sabot
{
namespace
{
/** The quadrilaterals of the six faces of a lattice of @p n intervals. @p
   order: the lattice point, x fastest, that each particle stands on. */
void add_skin(const std::array<unsigned int, 3> &n,
              const std::vector<std::size_t> &order, ParticleCloud &cloud)
{
  std::vector<std::size_t> particle(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    particle[order[i]] = i;
  const auto at = [&](const std::array<unsigned int, 3> &p) {
    return particle[p[0] + (n[0] + 1) * (p[1] + std::size_t(n[1] + 1) * p[2])];
  };
  for (unsigned int id = 0; id < 6; ++id)
  {
    // Across d; b follows c on the lower side, where outwards is downwards.
    const unsigned int d = id / 2, b = (d + (id % 2 ? 1 : 2)) % 3,
                       c = (d + (id % 2 ? 2 : 1)) % 3;
    for (unsigned int j = 0; j < n[c]; ++j)
      for (unsigned int i = 0; i < n[b]; ++i)
      {
        std::array<unsigned int, 3> p{};
        p[d] = id % 2 ? n[d] : 0;
        const auto corner = [&](const unsigned int di, const unsigned int dj)
        {
          p[b] = i + di;
          p[c] = j + dj;
          return at(p);
        };
        cloud.skin.push_back(
            {{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}});
        cloud.skin_id.push_back(id);
      }
  }
}
} // namespace

unsigned int n_intervals(const double length, const double spacing)
{
  return std::max(1u, static_cast<unsigned int>(std::lround(length / spacing)));
}

ParticleCloud make_box_cloud(const std::array<double, 3> &center,
                             const std::array<double, 3> &size,
                             const double nodal_spacing)
{
  return make_box_cloud(center, size,
                        {{nodal_spacing, nodal_spacing, nodal_spacing}});
}

ParticleCloud make_box_cloud(const std::array<double, 3> &center,
                             const std::array<double, 3> &size,
                             const std::array<double, 3> &nodal_spacing)
{
  ParticleCloud cloud;
  std::array<double, 3> n_points;
  for (unsigned int d = 0; d < 3; ++d)
    n_points[d] = count_of_intervals(size[d], nodal_spacing[d]) + 1.;
  check_memory_for(n_points, Item::particle);
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
      x[d] = center[d] - 0.5 * size[d] + size[d] * i / n[d];
      const bool low = i == 0, high = i == n[d];
      volume *= cloud.spacing[d] * (low || high ? 0.5 : 1.);
      faces |= (low ? 1u : 0u) << (2 * d) | (high ? 1u : 0u) << (2 * d + 1);
    }
    for (unsigned int id = 0; id < 6; ++id)
      if (faces >> id & 1)
      {
        const unsigned int d = id / 2;
        Vec area = {};
        // The volume behind a face is half a layer.
        area[d] = (id % 2 ? 2. : -2.) * volume / cloud.spacing[d];
        cloud.face_shares.push_back({cloud.position.size(), id, area});
      }
    cloud.position.push_back(x);
    cloud.volume.push_back(volume);
    cloud.on_face.push_back(faces);
  }
  add_skin(n, order, cloud);
  return cloud;
}

AlignedVector<Vec> outward_normals(const ParticleCloud &cloud,
                                   const std::uint32_t without)
{
  const std::size_t n = cloud.position.size();
  const auto counts = [&](const ParticleCloud::FaceShare &share)
  { return share.id >= ParticleCloud::n_faces || !(without >> share.id & 1); };
  AlignedVector<Vec> normal(n, Vec{});
  for (const ParticleCloud::FaceShare &share : cloud.face_shares)
    if (counts(share))
      normal[share.particle] += share.area;
  for (Vec &v : normal)
    if (norm_square(v) > 0.)
      v *= 1. / norm(v);
  std::vector<double> least(n, 1.);
  for (const ParticleCloud::FaceShare &share : cloud.face_shares)
    if (counts(share) && norm_square(share.area) > 0.)
      least[share.particle] =
          std::min(least[share.particle],
                   dot(share.area, normal[share.particle]) / norm(share.area));
  for (std::size_t i = 0; i < n; ++i)
    normal[i] *= std::max(0., least[i]);
  return normal;
}

std::vector<double> surface_spacings(const ParticleCloud &cloud,
                                     const std::uint32_t without)
{
  const std::size_t n = cloud.position.size();
  std::vector<double> spacing(n, 0.);
  std::vector<int> n_faces(n, 0);
  const auto at = [&](const std::size_t particle)
  {
    const auto &p = cloud.position[particle];
    return vec(p[0], p[1], p[2]);
  };
  for (std::size_t f = 0; f < cloud.skin.size(); ++f)
  {
    const unsigned int id = cloud.skin_id[f];
    if (id < ParticleCloud::n_faces && without >> id & 1)
      continue;
    const auto &face = cloud.skin[f];
    const double area =
        0.5 * norm(cross(at(face[2]) - at(face[0]), at(face[3]) - at(face[1])));
    for (const std::size_t particle : face)
    {
      spacing[particle] += area;
      ++n_faces[particle];
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    if (n_faces[i] > 0)
      spacing[i] = std::sqrt(spacing[i] / n_faces[i]);
  return spacing;
}
} // namespace sabot
