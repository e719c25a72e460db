#ifndef sabot_base_exact_sum_h
#define sabot_base_exact_sum_h

#include <mpi.h>

#include <vector>

namespace sabot
{
__extension__ typedef __int128 Int128;

/**
 * A sum that does not depend on the order of its terms, hence not on the
 * number of ranks: fixed point in a 128-bit integer with unit 2^-80 and range
 * +-1.4e14 (SI units). Each term is cut once, to 8e-25.
 * A term that is not finite or out of range makes the sum not-a-number.
 */
class ExactSum
{
public:
  void add(const double value);
  void add(const ExactSum &other);
  void subtract(const ExactSum &other);
  /** The sum, rounded to double. */
  double value() const;
  /** Sum over all ranks of every entry; all ranks must call it. */
  static void reduce(std::vector<ExactSum *> sums, MPI_Comm communicator);

private:
  Int128 sum = 0;
  long n_invalid = 0;
};
} // namespace sabot

#endif
