#ifndef sabot_kernels_principal_h
#define sabot_kernels_principal_h

#include "sabot/kernels/eigen.h"
#include "sabot/kernels/vec.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace sabot
{
// Inline, as a call would change the contraction of products and sums in the
// loops over particles; with Eigen's decompositions, which take seconds to
// parse: include this in source files only.

/** Whether all eigenvalues of the symmetric matrix m, of which the lower
    triangle is read, are above @p limit: m - limit 1 is positive definite,
   which its leading minors tell (Sylvester). False where any entry is no
   number. */
inline bool has_eigenvalues_above(const Mat &m, const double limit)
{
  const double a = m(0, 0) - limit, b = m(1, 1) - limit, c = m(2, 2) - limit;
  const double d = m(1, 0), e = m(2, 1), f = m(2, 0);
  const double minor = a * b - d * d;
  return a > 0. && minor > 0. &&
         c * minor - e * (a * e - d * f) - f * (b * f - d * e) > 0.;
}

/**
 * Inverse of a symmetric positive semidefinite moment matrix whose small
 * eigenvalues are damped: with the spectrum M = sum e_i n_i (x) n_i,
 *
 *   M^-1 ~ sum g(e_i) n_i (x) n_i,  g(e) = 1/e           for e >= threshold,
 *                                   g(e) = e/threshold^2 below,
 *
 * continuous at the threshold and zero where a direction is lost, so that
 * gradients fade there instead of growing without bound.
 * @param threshold  of the eigenvalues, in their unit, > 0
 * @param n_damped   out: number of directions below the threshold
 *
 * Eigenvalues below zero, which round-off makes, count as zero. Where none is
 * below the threshold the result is the inverse to round-off. At the threshold
 * both branches of g are 1/threshold, its largest value, which thus bounds the
 * norm of the result. @p moment is symmetric; of it only the lower triangle is
 * read (Eigen's SelfAdjointEigenSolver, iterative form). Eigenvalues are found
 * only where one is below the threshold.
 */
inline Mat damped_inverse(const Mat &moment, const double threshold,
                          int &n_damped)
{
  n_damped = 0;
  if (has_eigenvalues_above(moment, threshold))
    return inverse(moment);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(to_eigen(moment));
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

/**
 * Remove the tensile principal values of the symmetric tensor s (components xx,
 * yy, zz, xy, yz, xz; positive in tension): what a crack still carries.
 *   s <- s - sum_{e_i > 0} e_i n_i (x) n_i
 * with eigenvalues e_i and directions n_i of s. In place, in the unit it has; a
 * tensor without tension returns bit by bit as it was. By the closed form
 * (computeDirect), the error of which is about 1e-8 of the largest entry where
 * eigenvalues are close: what is left of tension is of that size.
 */
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

/**
 * Largest principal value of the symmetric tensor s (xx, yy, zz, xy, yz, xz),
 * in its unit; of a stress positive in tension.
 * By the closed form for 3x3 matrices, eigenvalues only. Compared with a
 * tensile strength it is the criterion of Rankine.
 */
inline double largest_principal(const double s[6])
{
  Eigen::Matrix3d m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2];
}

/**
 * Middle eigenvalue of a symmetric matrix, in its unit.
 * Of the moment matrix of a set of neighbors: zero where they lie on a line,
 * positive where they span at least a plane.
 */
inline double middle_eigenvalue(const Mat &moment)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(to_eigen(moment), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[1];
}

/**
 * Keep a support from growing or shrinking without bound: with the kernel
 * matrix @p h [m], that maps the unit ball to the present support, and the
 * initial semi-axes @p axes [m], h = h' diag(axes) and h' = U S V^T, limit the
 * singular values to S in [low, high]; rotation and axes of stretch stay.
 * @pre 0 < low < 1 < high. Kernels far from the limits return as they were.
 *
 * Column j of h over axes[j] makes h', the stretch of the support since the
 * start, without unit; its singular values are those of the square root of h'^T
 * h'. The cheap test: where h'^T h' - low^2 1 and high^2 1 - h'^T h' are
 * positive definite every singular value is within the limits. Singular values
 * are taken as at least 1e-6 in the division, for supports that have collapsed.
 */
inline Mat clamp_kernel(const Mat &h, const Vec axes, const double low,
                        const double high)
{
  const Vec divisor = axes + Vec{0., 0., 0., 1.};
  const Mat stretch = {
      {h.row[0] / divisor, h.row[1] / divisor, h.row[2] / divisor}};
  const Mat square = transpose(stretch) * stretch;
  // Most kernels are far from the limits, which shows without eigenvalues.
  if (has_eigenvalues_above(square, low * low) &&
      has_eigenvalues_above(-1. * square, -high * high))
    return h;
  const Eigen::Matrix3d m = to_eigen(stretch), c = to_eigen(square);
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

/**
 * The same for kernels that start as any regular matrix: h = h' @p initial.
 * @p initial [m] maps the unit ball to the support at the start; it is inverted
 * without a check of its determinant. The limits are those of the stretch h
 * initial^-1, of which the first index is of the present frame, the second of
 * the reference.
 */
inline Mat clamp_kernel(const Mat &h, const Mat &initial, const double low,
                        const double high)
{
  const Mat stretch = h * inverse(initial);
  return clamp_kernel(stretch, vec(1., 1., 1.), low, high) * initial;
}

/** Square root of a symmetric positive matrix. */
inline Mat square_root(const Mat &a)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(to_eigen(a));
  return from_eigen(solver.operatorSqrt());
}
} // namespace sabot

#endif
