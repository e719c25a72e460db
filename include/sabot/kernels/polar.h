#ifndef sabot_kernels_polar_h
#define sabot_kernels_polar_h

#include "sabot/kernels/vec.h"

namespace sabot
{
/**
 * R of the polar decomposition F = R U, by Newton's iteration
 * R <- (R + R^-T)/2 (Higham 1986), which converges quadratically: to round-off
 * in about five iterations for moderate stretch. U is symmetric positive
 * definite, R takes the reference frame to the present one. @pre det F > 0, not
 * checked.
 */
inline Mat rotation_of(const Mat &F)
{
  Mat R = (1. / std::cbrt(determinant(F))) * F;
  for (int iteration = 0; iteration < 30; ++iteration)
  {
    const Mat cofactor = {{cross(R.row[1], R.row[2]), cross(R.row[2], R.row[0]),
                           cross(R.row[0], R.row[1])}};
    const double half = 0.5 / dot(R.row[0], cofactor.row[0]);
    const Mat next = 0.5 * R + half * cofactor, change = next - R;
    R = next;
    // The next change would be of the order of this one's square.
    if (norm_square(change.row[0]) + norm_square(change.row[1]) +
            norm_square(change.row[2]) <
        1e-15)
      break;
  }
  return R;
}

/**
 * Spin increment (w_xy, w_yz, w_xz) whose Cayley transform
 * (1 - w/2)^-1 (1 + w/2) is the rotation @p R by less than half a turn:
 *
 *   w = 2/(1 + tr R) (R - R^T),
 *
 * so that rotate_symmetric() with it rotates by R exactly.
 */
inline void cayley_spin(const Mat &R, double spin[3])
{
  const double s = 2. / (1. + trace(R));
  spin[0] = s * (R(0, 1) - R(1, 0));
  spin[1] = s * (R(1, 2) - R(2, 1));
  spin[2] = s * (R(0, 2) - R(2, 0));
}
} // namespace sabot

#endif
