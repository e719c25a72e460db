#ifndef sabot_kernels_closest_point_h
#define sabot_kernels_closest_point_h

#include "sabot/kernels/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sabot
{
/**
 * Closest point of the triangle a, b, c to @p p as barycentric weights: the
 * point is w_0 a + w_1 b + w_2 c with w >= 0 and sum w = 1. By the regions of
 * Voronoi of corners, edges and face (Ericson, Real-Time Collision Detection,
 * 2005, 5.1.5), which need no division but in the region that is found. Any
 * frame and unit of length; the triangle must have an area.
 *
 * With d_ab = (b - a) . (p - a) and so on the products d1 to d6 of the code
 * tell the region, and va, vb, vc are the areas of the parts opposite a, b, c,
 * up to one common factor, so that inside
 *   w = (va, vb, vc)/(va + vb + vc).
 * Of a point that projects on a corner exactly the corner has all the weight;
 * ties between regions go to the first one asked, in the order a, b, ab, c, ac,
 * bc. Without an area a division may be 0/0 and give what is not a number.
 */
inline std::array<double, 3> closest_on_triangle(const Vec p, const Vec a,
                                                 const Vec b, const Vec c)
{
  const Vec ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0. && d2 <= 0.)
    return {{1., 0., 0.}};
  const Vec bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0. && d4 <= d3)
    return {{0., 1., 0.}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0. && d1 >= 0. && d3 <= 0.)
  {
    const double v = d1 / (d1 - d3);
    return {{1. - v, v, 0.}};
  }
  const Vec cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0. && d5 <= d6)
    return {{0., 0., 1.}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0. && d2 >= 0. && d6 <= 0.)
  {
    const double w = d2 / (d2 - d6);
    return {{1. - w, 0., w}};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0. && d4 - d3 >= 0. && d5 - d6 >= 0.)
  {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0., 1. - w, w}};
  }
  const double denominator = 1. / (va + vb + vc);
  const double v = vb * denominator, w = vc * denominator;
  return {{1. - v - w, v, w}};
}

/** Where a point stands with respect to a face; lengths in that of the points,
    usually meters in the present configuration. */
struct FaceProjection
{
  /**
   * To the closest point; infinite while there is none.
   * Of the offset p - foot [m^2].
   */
  double distance_square = std::numeric_limits<double>::infinity();
  /**
   * |n . offset|/|offset|: 1 above the inside of the face, less beside it, and
   * 1 by definition where the point lies on the face. Decides between triangles
   * that share the closest point, as at an edge.
   */
  double facing = 0.; // |cos| of the angle between offset and face normal
  /**
   * Above the inside of the face the distance from its plane, beside it the
   * distance to the edge or corner with the sign of that of the plane. [m]
   */
  double gap = 0.; // signed distance, negative inside
  /**
   * The face's above its inside, the offset over the gap beside it; in both
   * cases gap times normal is the vector from the foot to the point.
   */
  Vec normal = {};      // unit, outward, along which the gap is measured
  Vec face_normal = {}; // unit, outward, of the triangle
  /**
   * Less than the gap in size where the foot is on an edge or a corner: what
   * tells a point beside the face from one behind it. [m]
   */
  double along = 0.; // signed distance from the triangle's plane
  /**
   * Of the four corners, which give the closest point; sum 1.
   * A quarter of the center's weight is in each. A contact force on the point
   * acts on the four corners by these weights with the opposite sign, which
   * keeps linear momentum; along the normal it keeps angular momentum, too, as
   * the foot is their weighted mean.
   */
  std::array<double, 4> weight{{0., 0., 0., 0.}};
};

/**
 * The ball around the corners of a quadrilateral x. Whether all of the face is
 * farther from p than a distance, seen from it, is a cheap first question,
 * which says no where it is not sure. The ball has the mean of the corners as
 * its center c and the distance of the farthest corner as its radius r, so the
 * test is |p - c| > distance + r. All four triangles of project_on_face() lie
 * in the ball, as a ball is convex.
 */
struct FaceBall
{
  FaceBall() = default;
  explicit FaceBall(const std::array<Vec, 4> &x)
      : center(0.25 * (x[0] + x[1] + x[2] + x[3]))
  {
    double radius_square = 0.;
    for (const Vec corner : x)
      radius_square = std::max(radius_square, norm_square(corner - center));
    radius = std::sqrt(radius_square);
  }
  bool is_farther(const Vec p, const double distance) const
  {
    return norm(p - center) > distance + radius;
  }

  Vec center = {};
  double radius = 0.;
};

/**
 * Closest point of a quadrilateral, taken as four triangles around its center,
 * so that warped faces have no crack and no preferred diagonal.
 * The sign of the gap comes from the triangle's normal; the direction is the
 * normal where the foot lies inside the triangle, and the offset itself on
 * edges and corners. Of triangles that are equally close the one that faces the
 * point most counts. Corners counter-clockwise seen from outside; triangles
 * without an area are skipped.
 *
 * The center has a quarter of each corner, and so the foot x and its weights
 * w_a fulfill x = sum w_a x_a with sum w_a = 1 and w_a >= 0. Within 1e-12 of
 * the square of the distance two triangles count as equally close; a foot
 * counts as inside where the offset is parallel to the normal to 1e-9, or the
 * point lies on the face to 1e-12 of its size. Without any triangle that has an
 * area the distance stays infinite, and the caller has to look at that.
 */
inline FaceProjection project_on_face(const Vec p, const std::array<Vec, 4> &x)
{
  FaceProjection best;
  const Vec center = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  for (int a = 0; a < 4; ++a)
  {
    const int b = (a + 1) & 3;
    const auto w = closest_on_triangle(p, x[a], x[b], center);
    const Vec offset = p - (w[0] * x[a] + w[1] * x[b] + w[2] * center);
    const double d2 = norm_square(offset);
    if (d2 > best.distance_square * (1. + 1e-12))
      continue;
    const Vec area = cross(x[b] - x[a], center - x[a]);
    const double size = norm(area);
    if (size == 0.)
      continue;
    const Vec n = (1. / size) * area;
    const double along = dot(offset, n), distance = std::sqrt(d2);
    const double facing = distance > 0. ? std::abs(along) / distance : 1.;
    if (d2 > best.distance_square * (1. - 1e-12) && facing <= best.facing)
      continue;
    best.distance_square = d2;
    best.facing = facing;
    best.gap = along < 0. ? -distance : distance;
    best.face_normal = n;
    best.along = along;
    const bool inside =
        facing > 1. - 1e-9 || distance < 1e-12 * std::sqrt(size);
    best.normal = inside ? n : (1. / best.gap) * offset;
    if (inside)
      best.gap = along;
    const double quarter = 0.25 * w[2];
    best.weight = {{quarter, quarter, quarter, quarter}};
    best.weight[a] += w[0];
    best.weight[b] += w[1];
  }
  return best;
}
} // namespace sabot

#endif
