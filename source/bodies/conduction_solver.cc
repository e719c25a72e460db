// Conjugate gradients whose sums do not depend on the number of ranks.
#include "sabot/bodies/conduction_solver.h"

#include "sabot/base/error.h"
#include "sabot/base/exact_sum.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
unsigned int solve_conduction(
    const std::vector<double> &diagonal, const std::vector<double> &right,
    const std::function<void(std::vector<double> &, std::vector<double> &)>
        &multiply,
    std::vector<double> &x, MPI_Comm communicator)
{
  const std::size_t n = diagonal.size();
  const auto dot =
      [&](const std::vector<double> &a, const std::vector<double> &b)
  {
    ExactSum sum;
    for (std::size_t i = 0; i < n; ++i)
      sum.add(a[i] * b[i]);
    ExactSum::reduce({&sum}, communicator);
    return sum.value();
  };
  std::vector<double> r = right, z(n), p(x.size(), 0.), product(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    x[i] = 0.;
    p[i] = z[i] = r[i] / diagonal[i];
  }
  double rz = dot(r, z);
  // Temperatures to 1e-9 of the largest change, or to 1e-9 K of one node.
  const double limit = 1e-18 * std::max(rz, 1.);
  unsigned int n_iterations = 0;
  for (; rz > limit; ++n_iterations)
  {
    if (n_iterations > 10000 || !std::isfinite(rz))
      throw PhysicsError("heat conduction does not converge");
    multiply(p, product);
    const double alpha = rz / dot(p, product);
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] += alpha * p[i];
      r[i] -= alpha * product[i];
      z[i] = r[i] / diagonal[i];
    }
    const double next = dot(r, z), beta = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i)
      p[i] = z[i] + beta * p[i];
  }
  return n_iterations;
}
} // namespace sabot
