#ifndef sabot_kernels_tridiagonal_h
#define sabot_kernels_tridiagonal_h

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <vector>

namespace sabot
{
/** Largest eigenvalue of a symmetric tridiagonal matrix, the diagonal [n] and
    what stands beside it [n - 1]; n > 0. Scaled to 1 before, as Eigen's
    compute() does, but computeFromTridiagonal() does not: it lets go of what is
    beside the diagonal by a bound that has the unit of its root, does not come
    to an end with some matrices of large entries, and leaves eigenvalues
    unsorted then. */
inline double largest_eigenvalue(const std::vector<double> &diagonal,
                                 const std::vector<double> &beside)
{
  using Column = Eigen::Map<const Eigen::VectorXd>;
  const Column on(diagonal.data(), diagonal.size());
  const Column off(beside.data(), diagonal.size() - 1);
  double scale = on.cwiseAbs().maxCoeff();
  if (off.size() > 0)
    scale = std::max(scale, off.cwiseAbs().maxCoeff());
  if (!(scale > 0.))
    return 0.;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(on / scale, off / scale,
                                Eigen::EigenvaluesOnly);
  return scale * solver.eigenvalues().maxCoeff();
}
} // namespace sabot

#endif
