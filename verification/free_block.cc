// Natural frequencies of a free cube by Rayleigh-Ritz.
#include "verification/free_block.h"
#include "verification/linear_algebra.h"

#include <array>
#include <cmath>

namespace sabot
{
namespace
{
/** Integrals over [-1, 1] of orthonormal Legendre polynomials:
    d[a][b] = int p_a' p_b, dd[a][b] = int p_a' p_b'. */
struct Integrals
{
  Eigen::MatrixXd d, dd;

  explicit Integrals(const int n) : d(n, n), dd(n, n)
  {
    const auto scale = [](const int a, const int b)
    { return std::sqrt((a + 0.5) * (b + 0.5)); };
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
      {
        // int P_a' P_b = 2 for a - b = 1, 3, 5, ...
        d(a, b) = a > b && (a - b) % 2 == 1 ? 2. * scale(a, b) : 0.;
        // int P_a' P_b' = m (m + 1), m = min(a, b), for even a + b
        const int m = std::min(a, b);
        dd(a, b) = (a + b) % 2 == 0 ? m * (m + 1.) * scale(a, b) : 0.;
      }
  }
};
} // namespace

std::vector<double> free_cube_frequencies(const double length,
                                          const double density,
                                          const double lambda, const double mu,
                                          const unsigned int degree)
{
  std::vector<std::array<int, 3>> powers;
  const int n = degree + 1;
  for (int a = 0; a < n; ++a)
    for (int b = 0; a + b < n; ++b)
      for (int c = 0; a + b + c < n; ++c)
        powers.push_back({{a, b, c}});
  const Integrals one(n);
  const int size = powers.size();
  // int d_i p d_j q over the cube [-1, 1]^3
  const auto stiffness = [&](const int p, const int q, const int i, const int j)
  {
    double product = 1.;
    for (int d = 0; d < 3; ++d)
    {
      const int a = powers[p][d], b = powers[q][d];
      product *= d == i && d == j ? one.dd(a, b)
                 : d == i         ? one.d(a, b)
                 : d == j         ? one.d(b, a)
                                  : double(a == b);
      if (product == 0.)
        return 0.;
    }
    return product;
  };
  Eigen::MatrixXd K(3 * size, 3 * size);
  for (int p = 0; p < size; ++p)
    for (int q = 0; q < size; ++q)
    {
      double s[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          s[i][j] = stiffness(p, q, i, j);
      const double trace = s[0][0] + s[1][1] + s[2][2];
      // C_ikjl = lambda d_ik d_jl + mu (d_ij d_kl + d_il d_jk)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          K(3 * p + i, 3 * q + j) =
              lambda * s[i][j] + mu * s[j][i] + (i == j ? mu * trace : 0.);
    }
  std::vector<double> frequencies;
  for (const double eigenvalue : symmetric_eigenvalues(K))
    frequencies.push_back(std::sqrt(std::max(0., eigenvalue) / density) * 2. /
                          length);
  return frequencies;
}
} // namespace sabot
