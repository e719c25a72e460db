#ifndef sabot_kernels_symmetric_h
#define sabot_kernels_symmetric_h

#include "sabot/kernels/vec.h"

#include <cmath>

namespace sabot
{
/** A symmetric 3x3 matrix by its six entries. */
struct Symmetric
{
  double xx, yy, zz, xy, yz, xz;

  /** Add @p factor v (x) v. */
  void add_outer(const double factor, const Vec v)
  {
    xx += factor * v[0] * v[0];
    yy += factor * v[1] * v[1];
    zz += factor * v[2] * v[2];
    xy += factor * v[0] * v[1];
    yz += factor * v[1] * v[2];
    xz += factor * v[0] * v[2];
  }
  /**
   * At least the largest eigenvalue, and of a matrix without negative ones at
   * most 3 % above it, in the unit of the entries.
   *
   * With the mean m, p^2 = |A - m 1|^2/6 and 2 r = det(A - m 1)/p^3 it is m + p
   * y, y the largest root of y^3 - 3 y = 2 r in [1, 2]. Newton's steps from y =
   * 2 come down to it from above and never pass it, as the cubic is convex
   * there. They are fast unless the two largest are equal (y = 1), where each
   * halves what is left. Four steps: y is 1.08 for 1 there.
   */
  double largest_eigenvalue_bound() const
  {
    const double m = (xx + yy + zz) / 3., a = xx - m, b = yy - m, c = zz - m,
                 square = (a * a + b * b + c * c) / 6. +
                          (xy * xy + yz * yz + xz * xz) / 3.,
                 p = std::sqrt(square);
    if (!(p > 0.))
      return m;
    const double det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) +
                       xz * (xy * yz - b * xz),
                 two_r = det / (p * square);
    double y = 2.;
    for (int k = 0; k < 4; ++k)
      y = (2. * y * y * y + two_r) / (3. * (y * y - 1.));
    return m + p * y;
  }
};
} // namespace sabot

#endif
