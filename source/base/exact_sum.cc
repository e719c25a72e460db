// Sums that do not depend on the order of their terms.
#include "sabot/base/exact_sum.h"

#include <cmath>
#include <limits>

namespace sabot
{
void ExactSum::add(const ExactSum &other)
{
  sum += other.sum;
  n_invalid += other.n_invalid;
}

void ExactSum::subtract(const ExactSum &other)
{
  sum -= other.sum;
  n_invalid += other.n_invalid;
}

double ExactSum::value() const
{
  if (n_invalid > 0)
    return std::numeric_limits<double>::quiet_NaN();
  return std::ldexp(static_cast<double>(sum), -unit_exponent);
}

void ExactSum::reduce(std::vector<ExactSum *> sums, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1)
    return;
  // Low 48 bits, the rest in two parts, and the count of invalid terms: each
  // part adds up over ranks without overflow.
  const std::size_t n = sums.size();
  std::vector<std::int64_t> parts(4 * n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Int128 s = sums[i]->sum;
    const Int128 mask = (static_cast<Int128>(1) << 48) - 1;
    parts[4 * i] = static_cast<std::int64_t>(s & mask);
    parts[4 * i + 1] = static_cast<std::int64_t>((s >> 48) & mask);
    parts[4 * i + 2] = static_cast<std::int64_t>(s >> 96);
    parts[4 * i + 3] = sums[i]->n_invalid;
  }
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), parts.size(), MPI_INT64_T, MPI_SUM,
                communicator);
  for (std::size_t i = 0; i < n; ++i)
  {
    sums[i]->sum =
        static_cast<Int128>(parts[4 * i]) +
        static_cast<Int128>(parts[4 * i + 1]) * (static_cast<Int128>(1) << 48) +
        static_cast<Int128>(parts[4 * i + 2]) * (static_cast<Int128>(1) << 48) *
            (static_cast<Int128>(1) << 48);
    sums[i]->n_invalid = parts[4 * i + 3];
  }
}
} // namespace sabot
