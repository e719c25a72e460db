#ifndef sabot_couplings_pair_forces_h
#define sabot_couplings_pair_forces_h

#include "sabot/base/resultant.h"
#include "sabot/couplings/node_halo.h"

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * What each pair of bodies does to each other in a coupling of more than two:
 * which part of the force on a node comes from which body. Costs an entry per
 * touched node and step, so couplings of two bodies, whose forces at the slots
 * tell it already, have none. Sums are exact, and each force counts where its
 * node is owned.
 */
class PairForces
{
public:
  /** None. */
  PairForces() = default;
  /** Of these pairs, by number of bodies; of two bodies or one there is nothing
      to tell apart. */
  PairForces(const std::vector<std::pair<int, int>> &pairs,
             const std::vector<Body *> &bodies);

  /** Whether there are pairs to tell apart. */
  bool any() const { return !sides.empty(); }
  /** Before the forces of a step. */
  void clear() { pushes.clear(); }
  /** Force [N] on the node of @p slot by the body of the node of @p other. */
  void add(const NodeHalo &halo, const std::size_t slot,
           const std::size_t other, const Vec force);
  /** Impulses of the present forces along @p half_dt [s]. */
  void accumulate(const double half_dt);
  /** One on each body by each other one, named "@p source by OTHER".
      Collective. */
  std::vector<Resultant> resultants(const std::string &source,
                                    MPI_Comm communicator) const;
  void visit_state(StateVisitor &visitor);

private:
  struct Side
  {
    int on, by; // bodies
    std::string by_name;
  };
  struct Push
  {
    std::size_t side;
    Vec force; // [N]
  };
  std::vector<Side> sides;
  std::vector<std::int32_t> side_of; // a row for each body that is pushed
  std::size_t n_bodies = 0;
  AlignedVector<Push> pushes;           // on owned nodes, of the step
  std::vector<ExactVectorSum> impulses; // of each side [N s]
};
} // namespace sabot

#endif
