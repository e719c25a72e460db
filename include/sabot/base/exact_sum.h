#ifndef sabot_base_exact_sum_h
#define sabot_base_exact_sum_h

#include <mpi.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace sabot
{
__extension__ typedef __int128 Int128;

/**
 * A sum that does not depend on the order of its terms, hence not on the
 * number of ranks: fixed point in a 128-bit integer with unit 2^-80 and range
 * +-1.4e14 (SI units). Each term is cut once, to 8e-25; what is added after
 * that is exact, other than with the compensated sums of Kahan or Neumaier,
 * which still depend on the order.
 *
 * A term that is not finite, or of 7e13 and more, makes the sum not-a-number:
 * trouble stays visible, and is counted rather than added, so that it does not
 * depend on the order either.
 *
 * Energies, masses and momenta are summed with it, and what decides (a verdict,
 * a quantity of interest) follows from those sums: equal runs thus give equal
 * bytes of history.h5 on one rank and on many. Forces are not: their order is
 * fixed instead, by global numbers.
 */
class ExactSum
{
public:
  /** Add a term, cut towards zero to a multiple of 2^-80. Inline: rows of the
      histories add a few hundred thousand. */
  void add(const double value)
  {
    constexpr double largest_term = 7e13; // half of the range of the sum
    if (!(std::abs(value) < largest_term))
    {
      ++n_invalid;
      return;
    }
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    const int exponent = static_cast<int>(bits >> 52 & 0x7ff),
              shift = exponent - 1023 - 52 + unit_exponent;
    if (shift <= -64) // zero, or far below the unit
      return;
    const std::uint64_t mantissa =
        (bits & ((std::uint64_t(1) << 52) - 1)) | std::uint64_t(1) << 52;
    const Int128 magnitude = shift >= 0
                                 ? static_cast<Int128>(mantissa) << shift
                                 : static_cast<Int128>(mantissa >> -shift);
    // 0 or -1: signs change at random, a branch would be mispredicted.
    const Int128 sign = static_cast<std::int64_t>(bits) >> 63;
    sum += (magnitude ^ sign) - sign;
  }
  /** Add another sum, without any error. */
  void add(const ExactSum &other);
  /** Take another sum off, without any error; what was not a number stays. */
  void subtract(const ExactSum &other);
  /** The sum, rounded to the nearest double; NaN when a term was not valid. */
  double value() const;
  /** Replace every one of @p sums by its sum over the ranks of
      @p communicator, the same bits on all of them. Collective, with one
      message for all: ranks must give the same number of sums in one order. */
  static void reduce(std::vector<ExactSum *> sums, MPI_Comm communicator);

private:
  static constexpr int unit_exponent = 80;
  Int128 sum = 0;     // in units of 2^-80
  long n_invalid = 0; // terms that were not added
};
} // namespace sabot

#endif
