// Decompositions of 3 x 3 matrices by Eigen, whose headers stay here.
#include "sabot/kernels/principal.h"

#include "sabot/kernels/eigen.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace sabot
{
Mat damped_inverse(const Mat &moment, const double threshold, int &n_damped)
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

void cut_tension(double s[6])
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

double largest_principal(const double s[6])
{
  Eigen::Matrix3d m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2];
}

double middle_eigenvalue(const Mat &moment)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(to_eigen(moment), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[1];
}

Mat clamp_kernel(const Mat &h, const Vec axes, const double low,
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

Mat clamp_kernel(const Mat &h, const Mat &initial, const double low,
                 const double high)
{
  const Mat stretch = h * inverse(initial);
  return clamp_kernel(stretch, vec(1., 1., 1.), low, high) * initial;
}
} // namespace sabot
