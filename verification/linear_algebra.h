#ifndef verification_linear_algebra_h
#define verification_linear_algebra_h

#include <Eigen/Core>

namespace sabot
{
// Eigen's decompositions, compiled once for all problems: each costs seconds.

/** Eigenvalues of the symmetric matrix @p K, ascending; its lower triangle is
    read. */
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd &K);

/** The same with eigenvectors as columns. */
std::pair<Eigen::VectorXd, Eigen::MatrixXd>
symmetric_modes(const Eigen::MatrixXd &K);

/** u of K u = @p load for a symmetric positive definite @p K, by Cholesky. */
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd &K,
                                const Eigen::VectorXd &load);
} // namespace sabot

#endif
