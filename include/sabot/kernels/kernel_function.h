#ifndef sabot_kernels_kernel_function_h
#define sabot_kernels_kernel_function_h

#include "sabot/kernels/vec.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace sabot
{
/** Cubic spline on r in [0, 1], zero beyond (Wu & Wu 2018, Eq. 18). */
inline double cubic_spline(const double r)
{
  if (r >= 1.)
    return 0.;
  return r <= 0.5 ? 2. / 3. + r * r * (4. * r - 4.)
                  : 4. / 3. * (1. - r) * (1. - r) * (1. - r);
}

/** Derivative of cubic_spline() by r. */
inline double cubic_spline_slope(const double r)
{
  if (r >= 1.)
    return 0.;
  return r <= 0.5 ? r * (12. * r - 8.) : -4. * (1. - r) * (1. - r);
}

/** Kernel weight at @p xi = H^-1 dX: spline of the radius. */
struct SphericalKernel
{
  static double weight(const Vec xi) { return cubic_spline(norm(xi)); }
  /** Gradient by xi. */
  static Vec slope(const Vec xi)
  {
    const double r = norm(xi);
    return r > 0. ? cubic_spline_slope(r) / r * xi : Vec{};
  }
};

/** Product of splines along the kernel's axes (Wu & Wu 2018, Eq. 18). */
struct TensorKernel
{
  static double weight(const Vec xi)
  {
    return cubic_spline(std::abs(xi[0])) * cubic_spline(std::abs(xi[1])) *
           cubic_spline(std::abs(xi[2]));
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

inline Eigen::Matrix3d to_eigen(const Mat &a)
{
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m(i, j) = a(i, j);
  return m;
}

inline Mat from_eigen(const Eigen::Matrix3d &m)
{
  Mat a = Mat::zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      a.set(i, j, m(i, j));
  return a;
}

/**
 * Inverse of a symmetric moment matrix whose small eigenvalues are damped:
 * 1/e becomes e/threshold^2 below @p threshold, continuous there and zero
 * where a direction is lost. @p n_damped counts the damped directions.
 */
inline Mat damped_inverse(const Mat &moment, const double threshold,
                          int &n_damped)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(to_eigen(moment));
  n_damped = 0;
  Eigen::Vector3d inverse;
  for (int i = 0; i < 3; ++i)
  {
    const double e = std::max(0., solver.eigenvalues()[i]);
    inverse[i] = e < threshold ? e / (threshold * threshold) : 1. / e;
    n_damped += e < threshold;
  }
  return from_eigen(solver.eigenvectors() * inverse.asDiagonal() *
                    solver.eigenvectors().transpose());
}

/** Remove the tensile principal stresses of s (xx, yy, zz, xy, yz, xz). */
inline void cut_tension(double s[6])
{
  Eigen::Matrix3d m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m);
  if (!(solver.eigenvalues()[2] > 0.))
    return;
  const Eigen::Matrix3d &v = solver.eigenvectors();
  for (int i = 0; i < 3; ++i)
    if (solver.eigenvalues()[i] > 0.)
      m -= solver.eigenvalues()[i] * v.col(i) * v.col(i).transpose();
  const double cut[6] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)};
  std::copy(cut, cut + 6, s);
}

/** Largest principal value of s (xx, yy, zz, xy, yz, xz). */
inline double largest_principal(const double s[6])
{
  Eigen::Matrix3d m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2];
}

/** Middle eigenvalue of a symmetric matrix. */
inline double middle_eigenvalue(const Mat &moment)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(to_eigen(moment), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[1];
}

/** Limit the singular values of @p h = U S V^T to [low, high] (scaled by the
    initial semi-axes @p axes: h = h' diag(axes)). */
inline Mat clamp_kernel(const Mat &h, const Vec axes, const double low,
                        const double high)
{
  Eigen::Matrix3d m = to_eigen(h);
  for (int j = 0; j < 3; ++j)
    m.col(j) /= axes[j];
  const Eigen::Matrix3d c = m.transpose() * m;
  // Most kernels are far from the limits; the norm tells without eigenvalues.
  const double distance = (c - Eigen::Matrix3d::Identity()).norm();
  if (distance < std::min(1. - low * low, high * high - 1.))
    return h;
  // m = U S V^T: with V from m^T m, m V diag(s'/s) V^T has singular values s'.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(c);
  Eigen::Vector3d factor;
  for (int i = 0; i < 3; ++i)
  {
    const double s = std::sqrt(std::max(1e-12, solver.eigenvalues()[i]));
    factor[i] = std::clamp(s, low, high) / s;
  }
  Eigen::Matrix3d clamped = m * solver.eigenvectors() * factor.asDiagonal() *
                            solver.eigenvectors().transpose();
  for (int j = 0; j < 3; ++j)
    clamped.col(j) *= axes[j];
  return from_eigen(clamped);
}

/** The same for kernels that start as any matrix: h = h' @p initial. */
inline Mat clamp_kernel(const Mat &h, const Mat &initial, const double low,
                        const double high)
{
  const Mat stretch = h * inverse(initial);
  return clamp_kernel(stretch, vec(1., 1., 1.), low, high) * initial;
}
} // namespace sabot

#endif
