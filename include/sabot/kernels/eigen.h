#ifndef sabot_kernels_eigen_h
#define sabot_kernels_eigen_h

#include "sabot/kernels/vec.h"

#include <Eigen/Core>

namespace sabot
{
// Our matrices are three rows of padded vectors, for the hot loops; Eigen's are
// for decompositions. Include this in source files only: Eigen takes a second
// to parse. Both ways copy nine numbers, which a decomposition dwarfs.

/**
 * The same numbers as Eigen's matrix, m(i, j) = a(i, j).
 * A copy, column by column in memory as Eigen has it; the fourth lanes are left
 * out.
 */
inline Eigen::Matrix3d to_eigen(const Mat &a)
{
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m(i, j) = a(i, j);
  return m;
}

/**
 * And back.
 * The fourth lane of every row is zero, as Mat demands.
 */
inline Mat from_eigen(const Eigen::Matrix3d &m)
{
  Mat a = Mat::zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      a.set(i, j, m(i, j));
  return a;
}

} // namespace sabot

#endif
