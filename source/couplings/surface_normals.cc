// Normals of faces that do not jump from face to face, but at edges.
#include "sabot/couplings/surface_normals.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// Spreads up to which an own normal counts in full, and a surface may be a
// round one, and from which not: facets of 25 degrees to some that are as good
// as an edge.
constexpr double smooth = 0.1, edge = 0.3;

} // namespace

double may_be_round(const double spread)
{
  return std::clamp((edge - spread) / (edge - smooth), 0., 1.);
}

bool is_smooth(const SmoothNormal &own)
{
  return own.spread < edge;
}

Vec common_normal(const SmoothNormal &its, const SmoothNormal &own)
{
  constexpr double least = 1e-14; // angles of 1e-7: below, both are planes
  constexpr double plane = 1e-12;
  const double part = may_be_round(own.spread);
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
  cache.assign(corners.size(), AtCorners());
  rounds.assign(corners.size(), Round());
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

double SurfaceNormals::likeness(const Vec area, const Vec like)
{
  // Cosines from which faces belong together, and to which not at all.
  constexpr double smooth = 0.85, edge = 0.7;
  const double length = norm(area);
  return std::clamp(
      (dot(area, like) - edge * length) / ((smooth - edge) * length), 0., 1.);
}

SmoothNormal SurfaceNormals::around(const std::size_t slot,
                                    const Vec *const like) const
{
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
      const double part = like == nullptr ? 1. : likeness(mirrored, *like);
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

const SurfaceNormals::AtCorners &
SurfaceNormals::at_corners(const std::size_t face) const
{
  AtCorners &at = cache[face];
  if (at.version == halo.version())
    return at;
  at = AtCorners();
  at.version = halo.version();
  const Vec area = area_of(face);
  const double size = norm(area);
  if (!(size > 0.))
    return at;
  at.face = (1. / size) * area;
  for (int a = 0; a < 4; ++a)
    at.normal[a] = around(corners[face][a], &at.face);
  return at;
}

const SurfaceNormals::Round &SurfaceNormals::round(const std::size_t face) const
{
  const AtCorners &at = at_corners(face);
  Round &round = rounds[face];
  if (round.version == halo.version())
    return round;
  round = Round();
  round.version = halo.version();
  for (int a = 0; a < 4; ++a)
    round.corner[a] = round_surface(corners[face][a], at.face, at.normal[a]);
  return round;
}

SmoothNormal SurfaceNormals::of_face(const std::size_t face,
                                     const std::array<double, 4> &weight) const
{
  const AtCorners &at = at_corners(face);
  SmoothNormal normal;
  if (norm_square(at.face) == 0.)
    return normal;
  for (int a = 0; a < 4; ++a)
    if (weight[a] > 0.)
    {
      const SmoothNormal &corner = at.normal[a];
      normal.direction += weight[a] * corner.direction;
      normal.spread += weight[a] * corner.spread;
      normal.reach += weight[a] * corner.reach;
    }
  const double length = norm(normal.direction);
  normal.direction = length > 0. ? (1. / length) * normal.direction : at.face;
  return normal;
}

std::vector<unsigned int>
SurfaceNormals::axes_across(const std::size_t slot) const
{
  std::vector<unsigned int> axes;
  for (const SymmetryPlane &plane : planes[halo.key(slot).body])
    if (std::abs(halo.position[slot][plane.axis] - plane.coordinate) < nearness)
      axes.push_back(plane.axis);
  return axes;
}

double SurfaceNormals::bulge(const std::size_t face,
                             const std::array<double, 4> &weight) const
{
  const Round &at = round(face);
  const auto &c = corners[face];
  Vec x = {};
  for (int a = 0; a < 4; ++a)
    x += weight[a] * halo.position[c[a]];
  double sum = 0.;
  for (int a = 0; a < 4; ++a)
    sum += at.corner[a].part * weight[a] *
           dot(halo.position[c[a]] - x, at.corner[a].normal);
  return 0.5 * sum;
}

Mat SurfaceNormals::curvature(const std::size_t face,
                              const std::array<double, 4> &weight) const
{
  const Round &at = round(face);
  Mat K = Mat::zero();
  for (int a = 0; a < 4; ++a)
    K = K + (at.corner[a].part * weight[a]) * at.corner[a].curvature;
  return K;
}

template <typename Action>
void SurfaceNormals::for_edges(const std::size_t slot, const Vec like,
                               const Action &action) const
{
  MirrorImages images;
  images.find(planes[halo.key(slot).body], halo.position[slot], nearness);
  for (std::size_t k = first_of_slot[slot]; k < first_of_slot[slot + 1]; ++k)
  {
    const auto &c = corners[face_of_slot[k]];
    const Vec area = area_of(face_of_slot[k]);
    const int a = std::find(c.begin(), c.end(), slot) - c.begin();
    Vec edge[3];
    for (int i = 0; i < 3; ++i)
      edge[i] = halo.position[c[(a + 1 + i) & 3]] - halo.position[slot];
    for (unsigned int image = 0; image < images.size(); ++image)
    {
      const unsigned int axes = images.axes(image);
      const double part = likeness(flipped(area, axes), like);
      if (part > 0.)
        action(part, edge, axes);
    }
  }
}

SurfaceNormals::RoundCorner
SurfaceNormals::round_surface(const std::size_t slot, const Vec like,
                              const SmoothNormal &mean) const
{
  RoundCorner corner;
  corner.normal = mean.direction;
  corner.part = may_be_round(mean.spread);
  if (!(corner.part > 0.))
    return corner;
  Vec sum = {};
  for_edges(
      slot, like,
      [&](const double part, const Vec *const edge, const unsigned int axes)
      {
        sum += flipped((part / (norm_square(edge[0]) * norm_square(edge[2]))) *
                           cross(edge[0], edge[2]),
                       axes);
      });
  const double length = norm(sum);
  if (length > 0. && std::isfinite(length))
    corner.normal = (1. / length) * sum;
  fit_curvature(slot, like, corner);
  return corner;
}

void SurfaceNormals::fit_curvature(const std::size_t slot, const Vec like,
                                   RoundCorner &corner) const
{
  const Vec r = corner.normal;
  Vec p = std::abs(r[0]) < 0.7 ? vec(1., 0., 0.) : vec(0., 1., 0.);
  p -= dot(p, r) * r;
  p *= 1. / norm(p);
  const Vec q = cross(r, p);
  Mat equations = Mat::zero();
  Vec right = {};
  double all = 0., flat = 0.;
  for_edges(
      slot, like,
      [&](const double part, const Vec *const edge, const unsigned int axes)
      {
        for (int i = 0; i < 3; ++i)
        {
          const Vec e = flipped(edge[i], axes);
          const double square = norm_square(e), u = dot(e, p), v = dot(e, q),
                       height = -2. * dot(e, r);
          if (!(square > 0.))
            continue;
          const double weight = part / (square * square);
          const Vec row = vec(u * u, 2. * u * v, v * v);
          add_outer(equations, weight * row, row);
          right += (weight * height) * row;
          all += weight * height * height;
          flat += weight * square;
        }
      });
  const double size = equations(0, 0) + equations(1, 1) + equations(2, 2);
  if (!(determinant(equations) > 1e-6 * size * size * size))
  {
    corner.part = 0.;
    return;
  }
  const Vec k = inverse(equations) * right;
  // What the parabola does not explain: nothing of a ball, half of crumpled
  // metal. Angles of less than 0.01 are a plane's, whose noise says nothing.
  constexpr double round = 0.1, crumpled = 0.3, straight = 1e-4;
  const double rest = (all - dot(k, right)) / (all + straight * flat);
  corner.part *= std::clamp((crumpled - rest) / (crumpled - round), 0., 1.);
  add_outer(corner.curvature, k[0] * p + k[1] * q, p);
  add_outer(corner.curvature, k[1] * p + k[2] * q, q);
}
} // namespace sabot
