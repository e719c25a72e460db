#ifndef sabot_kernels_kernel_function_h
#define sabot_kernels_kernel_function_h

#include "sabot/kernels/pack.h"
#include "sabot/kernels/vec.h"

#include <cmath>

namespace sabot
{
/**
 * Cubic B-spline of the normalized radius, 2/3 at the center and zero from
 * r = 1 on (Wu & Wu 2018, Eq. 18, with r = |x|/a for the support size a):
 *
 *   phi = 2/3 - 4 r^2 + 4 r^3   for r <= 1/2,
 *   phi = 4/3 (1 - r)^3         for 1/2 < r <= 1.
 *
 * Dimensionless; twice continuously differentiable. @pre r >= 0.
 */
inline double cubic_spline(const double r)
{
  if (r >= 1.)
    return 0.;
  return r <= 0.5 ? 2. / 3. + r * r * (4. * r - 4.)
                  : 4. / 3. * (1. - r) * (1. - r) * (1. - r);
}

/** Of four at once, without branches: 4/3 (1 - r)^3 less 16/3 (1/2 - r)^3, of
    which what is negative in brackets counts as zero. The same to round-off. */
inline Pack cubic_spline(const Pack r)
{
  const Pack a = pack_max(1. - r, Pack{}), b = pack_max(0.5 - r, Pack{});
  return 4. / 3. * (a * a * a - 4. * (b * b * b));
}

/** d phi/d r of cubic_spline(): 12 r^2 - 8 r inside of r = 1/2, -4 (1 - r)^2
    outside; zero at the center and from r = 1 on. */
inline double cubic_spline_slope(const double r)
{
  if (r >= 1.)
    return 0.;
  return r <= 0.5 ? r * (12. * r - 8.) : -4. * (1. - r) * (1. - r);
}

/**
 * Weight of a neighbor by the radius in the space of the kernel: with the
 * matrix H that maps the unit ball to the support (an ellipsoid) and the offset
 * dX [m], xi = H^-1 dX is dimensionless and w = phi(|xi|).
 */
struct SphericalKernel
{
  static double weight(const Vec xi) { return cubic_spline(norm(xi)); }
  /** Of four neighbors, by components. */
  static Pack weight(const Pack xi[3])
  {
    return cubic_spline(
        pack_sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]));
  }
  /** d w/d xi; the gradient by X is H^-T times it [1/m]. */
  static Vec slope(const Vec xi)
  {
    const double r = norm(xi);
    return r > 0. ? cubic_spline_slope(r) / r * xi : Vec{};
  }
};

/**
 * Product of three splines along the kernel's axes, whose support is a box:
 * w = phi(|xi_1|) phi(|xi_2|) phi(|xi_3|) (Wu & Wu 2018, Eq. 18). Same
 * interface as the spherical kernel; loops take either as a template argument.
 */
struct TensorKernel
{
  static double weight(const Vec xi)
  {
    return cubic_spline(std::abs(xi[0])) * cubic_spline(std::abs(xi[1])) *
           cubic_spline(std::abs(xi[2]));
  }
  static Pack weight(const Pack xi[3])
  {
    return cubic_spline(pack_max(xi[0], -xi[0])) *
           cubic_spline(pack_max(xi[1], -xi[1])) *
           cubic_spline(pack_max(xi[2], -xi[2]));
  }
  static Vec slope(const Vec xi)
  {
    double w[3], s[3];
    for (int d = 0; d < 3; ++d)
    {
      w[d] = cubic_spline(std::abs(xi[d]));
      s[d] = std::copysign(cubic_spline_slope(std::abs(xi[d])), xi[d]);
    }
    return vec(s[0] * w[1] * w[2], w[0] * s[1] * w[2], w[0] * w[1] * s[2]);
  }
};
} // namespace sabot

#endif
