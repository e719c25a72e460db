// Decompositions of dense matrices for verification problems.
#include "verification/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace sabot
{
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd &K)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues();
}

std::pair<Eigen::VectorXd, Eigen::MatrixXd>
symmetric_modes(const Eigen::MatrixXd &K)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd &K,
                                const Eigen::VectorXd &load)
{
  return K.llt().solve(load);
}
} // namespace sabot
