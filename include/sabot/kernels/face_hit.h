#ifndef sabot_kernels_face_hit_h
#define sabot_kernels_face_hit_h

#include "sabot/kernels/vec.h"

#include <array>
#include <cmath>
#include <limits>

namespace sabot
{
/** Where a line meets a face; lengths in that of the points. */
struct FaceHit
{
  /** From the point along the direction, positive where the face lies ahead:
      the depth of a point behind it. Infinite: nothing was met. */
  double ahead = std::numeric_limits<double>::infinity();
  std::array<double, 4> weight{{0., 0., 0., 0.}}; // of the corners, sum 1
};

/**
 * Where the line p + s n meets the quadrilateral @p x, taken as four triangles
 * around its center as in project_on_face(). Only triangles that look along n
 * count. Of the places the one closest to p is kept, also against @p best as it
 * comes in.
 *
 * Seen along n the areas of the parts of a triangle opposite its corners,
 *   A_a = n . (b - p) x (c - p),   A = n . (b - a) x (c - a) > 0,
 * are its barycentric weights A_a/A; so a line along a shared edge meets both
 * triangles with the same weights, and the foot is continuous across it. A part
 * of 1e-9 beyond an edge still counts, so that no line passes between two.
 * @param n: unit.
 * @return whether @p best changed.
 */
inline bool hit_face(const Vec p, const Vec n, const std::array<Vec, 4> &x,
                     FaceHit &best)
{
  constexpr double beyond = 1e-9;
  bool found = false;
  const Vec center = 0.25 * (x[0] + x[1] + x[2] + x[3]) - p;
  for (int a = 0; a < 4; ++a)
  {
    const int b = (a + 1) & 3;
    const Vec xa = x[a] - p, xb = x[b] - p;
    const double area = dot(n, cross(xb - xa, center - xa));
    if (!(area > 0.))
      continue;
    const double wa = dot(n, cross(xb, center)) / area,
                 wb = dot(n, cross(center, xa)) / area, wc = 1. - wa - wb;
    if (wa < -beyond || wb < -beyond || wc < -beyond)
      continue;
    const double ahead = dot(n, wa * xa + wb * xb + wc * center);
    if (!(std::abs(ahead) < std::abs(best.ahead)))
      continue;
    best.ahead = ahead;
    best.weight.fill(0.25 * wc);
    best.weight[a] += wa;
    best.weight[b] += wb;
    found = true;
  }
  return found;
}
} // namespace sabot

#endif
