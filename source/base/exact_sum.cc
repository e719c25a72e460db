// Sums that do not depend on the order of their terms.
#include "sabot/base/exact_sum.h"

#include "sabot/kernels/pack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

void ExactSum::add(const double *const terms, const std::size_t n)
{
  constexpr std::size_t most = std::size_t(n_lanes) << 11;
  for (std::size_t begin = 0; begin < n; begin += most)
    add_block(terms + begin, std::min(most, n - begin));
}

void ExactSum::add_block(const double *const terms, const std::size_t n)
{
  // Three parts of every term, each a multiple of its unit u by (x + 1.5 2^52
  // u)
  // - 1.5 2^52 u and below 2^42 u, so that sums of 2^11 are exact. Part and
  // rest are exact, but for the last rest, which is what rounding leaves out.
  constexpr double small = 1 << 14,
                   shifter[3] = {0x1.8p24, 0x1.8p-19, 0x1.8p-60};
  static_assert(unit_exponent == 112, "the unit of the last part");
  Pack sums[3] = {};
  for (std::size_t i = 0; i < n; i += n_lanes)
  {
    Pack x = {};
    if (i + n_lanes <= n)
      std::memcpy(&x, terms + i, sizeof(x));
    else
      for (std::size_t l = 0; l < n - i; ++l)
        x[l] = terms[i + l];
    const auto is_small = (x > -small) & (x < small);
    if (!in_all_lanes(is_small))
    {
      for (std::size_t l = 0; l < n_lanes; ++l)
        if (!is_small[l])
          add_large(x[l]);
      x = is_small ? x : Pack{};
    }
    for (int part = 0; part < 3; ++part)
    {
      const Pack of_part = (x + shifter[part]) - shifter[part];
      sums[part] += of_part;
      x -= of_part;
    }
  }
  for (const Pack &sum_of_part : sums)
    for (std::size_t l = 0; l < n_lanes; ++l)
      add(sum_of_part[l]);
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
