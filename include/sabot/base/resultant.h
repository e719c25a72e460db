#ifndef sabot_base_resultant_h
#define sabot_base_resultant_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/state_visitor.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <string>
#include <vector>

namespace sabot
{
/**
 * What one source does to one body as a whole: the force at this moment, and
 * its impulse since the start. In the fixed frame; the same on all ranks.
 * Impulses are summed with the very products that move the nodes, so that the
 * momentum of a body is that of the start plus all its impulses, to round-off.
 */
struct Resultant
{
  std::string source;            // "clamped faces", or a coupling's name
  int body;                      // on which it acts, Body::id
  std::array<double, 3> force;   // [N]
  std::array<double, 3> impulse; // [N s]
  bool is_outside = false;       // the source is no body of the scene
};

/** A vector summed without regard to the order of its terms. */
class ExactVectorSum
{
public:
  void add(const Vec v)
  {
    for (int d = 0; d < 3; ++d)
      sum[d].add(v[d]);
  }
  /** Another sum, without any error. */
  void add(const ExactVectorSum &other)
  {
    for (int d = 0; d < 3; ++d)
      sum[d].add(other.sum[d]);
  }
  /** Of this rank, or of all after reduce(). */
  std::array<double, 3> value() const
  {
    return {{sum[0].value(), sum[1].value(), sum[2].value()}};
  }
  /** Over the ranks of @p communicator; collective, in one message. */
  static void reduce(const std::vector<ExactVectorSum *> &sums,
                     MPI_Comm communicator)
  {
    std::vector<ExactSum *> components;
    for (ExactVectorSum *const s : sums)
      for (ExactSum &component : s->sum)
        components.push_back(&component);
    ExactSum::reduce(components, communicator);
  }

private:
  std::array<ExactSum, 3> sum;
};
} // namespace sabot

#endif
