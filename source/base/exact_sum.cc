// Sums that do not depend on the order of their terms.
#include "sabot/base/exact_sum.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace sabot
{
namespace
{
constexpr int unit_exponent = 80;
constexpr double largest_term = 7e13; // half of the range of the sum
} // namespace

void ExactSum::add(const double value)
{
  if (!(std::abs(value) < largest_term))
  {
    ++n_invalid;
    return;
  }
  // Mantissa and exponent by their bits: sums are made every step.
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
  if (exponent == 0) // zero, or far below the unit
    return;
  const std::uint64_t mantissa =
      (bits & ((std::uint64_t(1) << 52) - 1)) | std::uint64_t(1) << 52;
  const int shift = exponent - 1023 - 52 + unit_exponent;
  if (shift <= -64)
    return;
  const Int128 magnitude = shift >= 0 ? static_cast<Int128>(mantissa) << shift
                                      : static_cast<Int128>(mantissa >> -shift);
  sum += bits >> 63 ? -magnitude : magnitude;
}

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
