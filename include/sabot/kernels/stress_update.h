#ifndef sabot_kernels_stress_update_h
#define sabot_kernels_stress_update_h

#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sabot
{
/**
 * t <- R t R^T for @p n symmetric tensors (xx, yy, zz, xy, yz, xz), with the
 * rotation R = (1 - w/2)^-1 (1 + w/2) of the spin increment w = W dt (Hughes
 * and Winget 1980), exact for a rigid rotation when w is taken in the mid
 * configuration. @p spin: w_xy, w_yz, w_xz.
 *
 * W_ij = (dv_i/dx_j - dv_j/dx_i)/2 and w_xy is its entry (0, 1); arrays are
 * [component][point], n entries each, rotated in place, in the unit they have.
 * With the axial vector a of w/2 the rotation is
 *   R = 1 + 2/(1 + a . a) (a^ + a^ a^),
 * a^ the skew matrix of a, orthogonal to round-off for any spin; it turns by 2
 * arctan |a|, short of the angle of the step by a term of third order.
 * Invariants of the tensor are thus kept however large the step. (T. J. R.
 * Hughes and J. Winget, Int. J. Numer. Meth. Eng. 15 (1980) 1862.)
 */
inline void rotate_symmetric(const std::size_t n, const double *const spin[3],
                             double *const t[6])
{
#pragma GCC ivdep // components do not overlap
  for (std::size_t k = 0; k < n; ++k)
  {
    // Axial vector: w r = a x r.
    const double a0 = -0.5 * spin[1][k], a1 = 0.5 * spin[2][k],
                 a2 = -0.5 * spin[0][k];
    const double s = 2. / (1. + a0 * a0 + a1 * a1 + a2 * a2);
    const double r00 = 1. - s * (a1 * a1 + a2 * a2), r01 = s * (a0 * a1 - a2),
                 r02 = s * (a0 * a2 + a1), r10 = s * (a0 * a1 + a2),
                 r11 = 1. - s * (a0 * a0 + a2 * a2), r12 = s * (a1 * a2 - a0),
                 r20 = s * (a0 * a2 - a1), r21 = s * (a1 * a2 + a0),
                 r22 = 1. - s * (a0 * a0 + a1 * a1);
    const double xx = t[0][k], yy = t[1][k], zz = t[2][k], xy = t[3][k],
                 yz = t[4][k], xz = t[5][k];
    const double p00 = r00 * xx + r01 * xy + r02 * xz,
                 p01 = r00 * xy + r01 * yy + r02 * yz,
                 p02 = r00 * xz + r01 * yz + r02 * zz,
                 p10 = r10 * xx + r11 * xy + r12 * xz,
                 p11 = r10 * xy + r11 * yy + r12 * yz,
                 p12 = r10 * xz + r11 * yz + r12 * zz,
                 p20 = r20 * xx + r21 * xy + r22 * xz,
                 p21 = r20 * xy + r21 * yy + r22 * yz,
                 p22 = r20 * xz + r21 * yz + r22 * zz;
    t[0][k] = p00 * r00 + p01 * r01 + p02 * r02;
    t[1][k] = p10 * r10 + p11 * r11 + p12 * r12;
    t[2][k] = p20 * r20 + p21 * r21 + p22 * r22;
    t[3][k] = p00 * r10 + p01 * r11 + p02 * r12;
    t[4][k] = p10 * r20 + p11 * r21 + p12 * r22;
    t[5][k] = p00 * r20 + p01 * r21 + p02 * r22;
  }
}

/**
 * Rotate the @p n strain increments (tensor components, not engineering shear)
 * of the middle configuration to the end of the step, where the rotated stress
 * is: by half of @p spin. Without it a hypoelastic update is of first order
 * only and a vibrating, spinning body gains energy. At most @p capacity points.
 *
 * Here the increment is the symmetric part of dt dv/dx at x(n+1/2), whose axes
 * are turned by half of the step's rotation against those at x(n+1). @p n above
 * @p capacity would write beyond the buffer; it is not checked.
 */
template <std::size_t capacity>
inline void rotate_strain_to_end(const std::size_t n,
                                 const double *const spin[3],
                                 double *const strain[6])
{
  double half_spin_of[3][capacity];
  const double *half_spin[3];
  for (int c = 0; c < 3; ++c)
  {
    half_spin[c] = half_spin_of[c];
    for (std::size_t k = 0; k < n; ++k)
      half_spin_of[c][k] = 0.5 * spin[c][k];
  }
  rotate_symmetric(n, half_spin, strain);
}

/**
 * energy += half_volume stress : strain_increment for @p n points; called with
 * the old (rotated) and the new stress it is the trapezoidal rule. Stress [Pa]
 * and strain increments by components [6][n], off-diagonal ones counted twice;
 * half_volume: half of the mean volume of the step [m^3]; energy [J].
 *
 * Twice per step:
 *   dE = V/2 (sigma_n + sigma_n+1) : d_eps.
 * Positive where the stress does work on the material, the internal energy's
 * growth without heat. Stress and strain must be of the same frame, that of the
 * end of the step. Arrays must not overlap.
 */
inline void half_work(const std::size_t n, const double *const stress[6],
                      const double *const strain[6], const double *half_volume,
                      double *energy)
{
#pragma GCC ivdep
  for (std::size_t k = 0; k < n; ++k)
    energy[k] +=
        half_volume[k] *
        (stress[0][k] * strain[0][k] + stress[1][k] * strain[1][k] +
         stress[2][k] * strain[2][k] +
         2. * (stress[3][k] * strain[3][k] + stress[4][k] * strain[4][k] +
               stress[5][k] * strain[5][k]));
}

/**
 * Artificial bulk viscosity, a pressure [Pa] that spreads shocks over some
 * cells: q = rho h (c1 c |d| + c2 h d^2) in compression (d = tr D < 0), else 0
 * (von Neumann & Richtmyer 1950; the linear term: Landshoff 1955).
 * @param density  present one, rho [kg/m^3]
 * @param c        speed of sound [m/s]
 * @param h        size of the cell in the direction of the shock [m]
 * @param rate     d [1/s]
 *
 * Positive in compression and to be taken off the normal stresses; it enters
 * the forces and the energy, but no law's yield condition. With c1 = @p linear
 * (about 0.06) and c2 = @p quadratic (about 1.5), both without unit: the first
 * damps the ringing behind a front, the second sets the width of a strong one.
 * Zero in expansion, so that rarefaction waves stay sharp.
 */
inline double bulk_viscosity_pressure(const double density, const double c,
                                      const double h, const double rate,
                                      const double linear,
                                      const double quadratic)
{
  const double d = std::max(0., -rate);
  return density * h * d * (linear * c + quadratic * h * d);
}

/**
 * Von Mises stress sqrt(3/2 s : s) of the deviator s of one tensor (xx, yy, zz,
 * xy, yz, xz), in its unit.
 * Tensor components, no engineering shears: off-diagonal ones count twice in s
 * : s. Equals |sigma| in uniaxial stress and sqrt(3) |tau| in simple shear.
 * Pressure has no part in it.
 */
inline double von_mises(const double s[6])
{
  const double m = (s[0] + s[1] + s[2]) / 3.;
  const double a = s[0] - m, b = s[1] - m, c = s[2] - m;
  return std::sqrt(1.5 * (a * a + b * b + c * c +
                          2. * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])));
}
} // namespace sabot

#endif
