// Sums that do not depend on the order of their terms.
#include "sabot/base/exact_sum.h"

#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
/** The part of the low word that counts as one of the high. */
constexpr int word_exponent = 128;
} // namespace

void ExactSum::add_large(const double value)
{
  constexpr double largest_term = 1e18;
  if (!(std::abs(value) < largest_term))
  {
    ++n_invalid;
    return;
  }
  // Both parts are exact.
  const double high =
      std::nearbyint(std::ldexp(value, unit_exponent - word_exponent));
  const double low = value - std::ldexp(high, word_exponent - unit_exponent);
  const double part = 0.5 * low;
  add(part);
  add(low - part);
  overflow += static_cast<std::int64_t>(high);
}

void ExactSum::add(const ExactSum &other)
{
  add(other.sum, other.overflow);
  n_invalid += other.n_invalid;
}

void ExactSum::subtract(const ExactSum &other)
{
  // -s - 1 exists where -s does not.
  add(~other.sum, -other.overflow);
  add(1, 0);
  n_invalid += other.n_invalid;
}

double ExactSum::value() const
{
  if (n_invalid > 0)
    return std::numeric_limits<double>::quiet_NaN();
  const double low = std::ldexp(static_cast<double>(sum), -unit_exponent);
  return overflow == 0 ? low
                       : std::ldexp(static_cast<double>(overflow),
                                    word_exponent - unit_exponent) +
                             low;
}

void ExactSum::reduce(std::vector<ExactSum *> sums, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1)
    return;
  // Low 48 bits, the rest of the low word in two parts, the high word, and the
  // count of invalid terms: each part adds up over ranks without overflow.
  constexpr int width = 48, last_width = word_exponent - 2 * width;
  constexpr std::int64_t mask = (std::int64_t(1) << width) - 1;
  const std::size_t n = sums.size(), n_parts = 5;
  std::vector<std::int64_t> parts(n_parts * n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Int128 s = sums[i]->sum;
    parts[n_parts * i] = static_cast<std::int64_t>(s) & mask;
    parts[n_parts * i + 1] = static_cast<std::int64_t>(s >> width) & mask;
    parts[n_parts * i + 2] = static_cast<std::int64_t>(s >> 2 * width);
    parts[n_parts * i + 3] = sums[i]->overflow;
    parts[n_parts * i + 4] = sums[i]->n_invalid;
  }
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), parts.size(), MPI_INT64_T, MPI_SUM,
                communicator);
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::int64_t *const part = &parts[n_parts * i];
    const std::int64_t second = part[1] + (part[0] >> width),
                       third = part[2] + (second >> width);
    // The part of the third that is a signed end of the low word.
    constexpr std::int64_t half = std::int64_t(1) << (last_width - 1);
    const std::int64_t carry = (third + half) >> last_width,
                       last = third - carry * 2 * half;
    sums[i]->sum =
        static_cast<Int128>(last) * (static_cast<Int128>(1) << 2 * width) +
        (static_cast<Int128>(second & mask) << width) + (part[0] & mask);
    sums[i]->overflow = part[3] + carry;
    sums[i]->n_invalid = part[4];
  }
}
} // namespace sabot
