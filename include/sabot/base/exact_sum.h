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
 * number of ranks: fixed point in 192 bits with unit 2^-112, for SI units from
 * a body of micrometers to one of a kilometer. Each term is cut once, to 2e-34;
 * what is added after that is exact, other than with the compensated sums of
 * Kahan or Neumaier, which still depend on the order.
 *
 * A term that is not finite, or of 1e18 and more, makes the sum not-a-number:
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
  /** Add a term, cut towards zero to a multiple of 2^-112. Inline: rows of the
      histories add a few hundred thousand. */
  void add(const double value)
  {
    // So that the term fits into the low word.
    constexpr double large = 1 << (126 - unit_exponent);
    if (!(std::abs(value) < large))
    {
      add_large(value);
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
    add((magnitude ^ sign) - sign, 0);
  }
  /** Add @p n terms: each is what add() of it adds but rounded to the nearest
      multiple of 2^-112 instead of cut, whatever block it comes in. Four at
      once, in a fifth of the time. */
  void add(const double *terms, const std::size_t n);
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
  static constexpr int unit_exponent = 112;
  /** Of at most 2^13 terms. */
  void add_block(const double *terms, const std::size_t n);
  /** Add a term that the low word may not hold, or an invalid one. */
  void add_large(const double value);
  void add(const Int128 low, const std::int64_t high)
  {
    if (__builtin_add_overflow(sum, low, &sum))
      overflow += low < 0 ? -1 : 1;
    overflow += high;
  }

  Int128 sum = 0;             // in units of 2^-112
  std::int64_t overflow = 0;  // in units of 2^16, as often as the sum wrapped
  std::int64_t n_invalid = 0; // terms that were not added
};

/**
 * Many terms of one sum, handed on by the block: for loops over all nodes or
 * cells of a body. The sum has them all only when this has gone.
 */
class ExactTerms
{
public:
  explicit ExactTerms(ExactSum &sum) : sum(sum) {}
  ExactTerms(const ExactTerms &) = delete;
  ExactTerms &operator=(const ExactTerms &) = delete;
  ~ExactTerms() { sum.add(terms, n); }
  void add(const double term)
  {
    terms[n++] = term;
    if (n == block)
    {
      sum.add(terms, n);
      n = 0;
    }
  }

private:
  static constexpr std::size_t block = 256;
  ExactSum &sum;
  std::size_t n = 0;
  double terms[block];
};
} // namespace sabot

#endif
