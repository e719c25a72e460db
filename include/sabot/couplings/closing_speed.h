#ifndef sabot_couplings_closing_speed_h
#define sabot_couplings_closing_speed_h

#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"

#include <optional>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Largest speed at which a node of one body of a pair can close in on a node of
 * the other [m/s]: max over pairs of |v_a - m| + |v_b - m|, each the largest of
 * its body. A bound whatever m is: it is the middle of the box around all
 * velocities of the bodies in the pairs when it was last asked for, so what
 * flies along with the scene costs nothing. Across planes of symmetry of any
 * body, which are walls for all, m is nothing, as in the whole, which so is
 * searched at the same steps: m is its own image, and the bound that of nodes
 * and images as well: |v_a - R v_b| <= |v_a - m| + |v_b - m|. One look at all
 * nodes, one reduction.
 */
class ClosingSpeed
{
public:
  /** @p bodies: all of the scene. Collective, the same on all ranks. */
  double largest(const std::vector<Body *> &bodies,
                 const std::vector<std::pair<int, int>> &pairs,
                 MPI_Comm communicator);
  void visit_state(StateVisitor &visitor)
  {
    visitor.visit_value("middle of velocities", middle);
  }

private:
  Vec middle = {};                      // [m/s]
  std::optional<unsigned int> mirrored; // axes, a bit each; found once
};
} // namespace sabot

#endif
