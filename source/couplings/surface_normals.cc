// Normals of faces that do not jump from face to face, but at edges.
#include "sabot/couplings/surface_normals.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// Spreads up to which an own normal counts in full, and from which it does not:
// facets of 25 degrees to some that are as good as an edge.
constexpr double smooth = 0.1, edge = 0.3;
} // namespace

bool is_smooth(const SmoothNormal &own)
{
  return own.spread < edge;
}

Vec common_normal(const SmoothNormal &its, const SmoothNormal &own)
{
  constexpr double least = 1e-14; // angles of 1e-7: below, both are planes
  constexpr double plane = 1e-12;
  const double part = std::clamp((edge - own.spread) / (edge - smooth), 0., 1.);
  if (part == 0. || norm_square(own.direction) == 0.)
    return its.direction;
  double its_weight = 1. / (its.spread + least),
         own_weight = part / (own.spread + least);
  if (its.spread < plane && own.spread < plane)
  {
    const double further = its.reach - own.reach;
    (further > 0. ? own_weight : its_weight) *=
        std::pow(1e-16, std::min(1., std::abs(further)));
  }
  const Vec sum = its_weight * its.direction - own_weight * own.direction;
  const double length = norm(sum);
  if (!(length > 0.) || !(dot(sum, its.direction) > 0.))
    return its.direction;
  return (1. / length) * sum;
}

double least_cosine_of_met_faces(const SmoothNormal &own)
{
  constexpr double cos_margin = 0.766, sin_margin = 0.643; // 40 degrees
  const double cosine = std::clamp(1. - 0.5 * own.spread, 0., 1.);
  return cosine * cos_margin - std::sqrt(1. - cosine * cosine) * sin_margin;
}

void SurfaceNormals::build(
    const std::vector<std::vector<SymmetryPlane>> &planes_of_bodies,
    const double distance, const std::vector<double> &reach)
{
  planes = planes_of_bodies;
  nearness = distance;
  reach_of_slot = reach;
  first_of_slot.assign(halo.size() + 1, 0);
  for (const auto &face : corners)
    for (const std::size_t slot : face)
      ++first_of_slot[slot + 1];
  for (std::size_t s = 0; s < halo.size(); ++s)
    first_of_slot[s + 1] += first_of_slot[s];
  face_of_slot.resize(first_of_slot.back());
  std::vector<std::size_t> next(first_of_slot.begin(), first_of_slot.end() - 1);
  for (std::size_t f = 0; f < corners.size(); ++f)
    for (const std::size_t slot : corners[f])
      face_of_slot[next[slot]++] = f;
}

Vec SurfaceNormals::area_of(const std::size_t face) const
{
  const auto &c = corners[face];
  return 0.5 * cross(halo.position[c[2]] - halo.position[c[0]],
                     halo.position[c[3]] - halo.position[c[1]]);
}

SmoothNormal SurfaceNormals::around(const std::size_t slot,
                                    const Vec *const like) const
{
  // Cosines from which faces belong together, and to which not at all.
  constexpr double smooth = 0.85, edge = 0.7;
  MirrorImages images;
  images.find(planes[halo.key(slot).body], halo.position[slot], nearness);
  Vec sum = {};
  double size = 0.;
  for (std::size_t k = first_of_slot[slot]; k < first_of_slot[slot + 1]; ++k)
  {
    const Vec area = area_of(face_of_slot[k]);
    const double length = norm(area);
    for (unsigned int image = 0; image < images.size(); ++image)
    {
      const Vec mirrored = flipped(area, images.axes(image));
      const double part =
          like == nullptr ? 1.
                          : std::clamp((dot(mirrored, *like) - edge * length) /
                                           ((smooth - edge) * length),
                                       0., 1.);
      if (!(part > 0.))
        continue;
      sum += part * mirrored;
      size += part * length;
    }
  }
  SmoothNormal normal;
  const double length = norm(sum);
  if (!(length > 0.))
    return normal;
  normal.direction = (1. / length) * sum;
  normal.spread = std::max(0., 2. * (1. - length / size));
  normal.reach = reach_of_slot.empty() ? 0. : reach_of_slot[slot];
  return normal;
}

SmoothNormal SurfaceNormals::of_node(const std::size_t slot) const
{
  return around(slot, nullptr);
}

SmoothNormal SurfaceNormals::of_face(const std::size_t face,
                                     const std::array<double, 4> &weight) const
{
  const Vec area = area_of(face);
  const double size = norm(area);
  SmoothNormal normal;
  if (!(size > 0.))
    return normal;
  const Vec own = (1. / size) * area;
  for (int a = 0; a < 4; ++a)
    if (weight[a] > 0.)
    {
      const SmoothNormal corner = around(corners[face][a], &own);
      normal.direction += weight[a] * corner.direction;
      normal.spread += weight[a] * corner.spread;
      normal.reach += weight[a] * corner.reach;
    }
  const double length = norm(normal.direction);
  normal.direction = length > 0. ? (1. / length) * normal.direction : own;
  return normal;
}
} // namespace sabot
