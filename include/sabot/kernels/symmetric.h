#ifndef sabot_kernels_symmetric_h
#define sabot_kernels_symmetric_h

#include "sabot/kernels/pack.h"

namespace sabot
{
/**
 * At least the largest eigenvalue of each of four symmetric 3x3 matrices
 * without negative ones, and at most 3 % above it; @p s xx, yy, zz, xy, yz, xz,
 * in their unit.
 *
 * With the mean m, p^2 = |A/m - 1|^2/6 and 2 r = det(A/m - 1)/p^3 it is m (1 +
 * p y), y the largest root of y^3 - 3 y = 2 r in [1, 2]. Newton's steps from y
 * = 2 come down to it from above and never pass it, as the cubic is convex
 * there. They are fast unless the two largest are equal (y = 1), where each
 * halves what is left. Four steps: y is 1.08 for 1 there.
 */
inline Pack largest_eigenvalue_bound(const Pack s[6])
{
  // Where all is zero, or nothing but the mean is there, any y will do.
  constexpr double least = 1e-200, least_square = 1e-60;
  const Pack m = (s[0] + s[1] + s[2]) / 3.,
             part = 1. / pack_max(m, Pack{least, least, least, least}),
             a = part * (s[0] - m), b = part * (s[1] - m),
             c = part * (s[2] - m), d = part * s[3], e = part * s[4],
             f = part * s[5],
             square = pack_max(
                 (a * a + b * b + c * c) / 6. + (d * d + e * e + f * f) / 3.,
                 Pack{least_square, least_square, least_square, least_square}),
             p = pack_sqrt(square),
             det = a * (b * c - e * e) - d * (d * c - e * f) +
                   f * (d * e - b * f),
             two_r = det / (p * square);
  Pack y = {2., 2., 2., 2.};
  for (int k = 0; k < 4; ++k)
    y = (2. * y * (y * y) + two_r) / (3. * (y * y - 1.));
  return m + m * p * y;
}
} // namespace sabot

#endif
