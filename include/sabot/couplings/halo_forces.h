#ifndef sabot_couplings_halo_forces_h
#define sabot_couplings_halo_forces_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/couplings/node_halo.h"
#include "sabot/couplings/pair_forces.h"

#include <utility>

namespace sabot
{
/**
 * Normal and friction forces at the slots of a halo, and their work on the
 * owned nodes: what all contacts have. A coupling sets normal and friction for
 * all slots; those of nodes owned here are complete, for whoever owns a node
 * computes all that acts on it, and only they go to the bodies and into the
 * work. Work is W = sum f . v dt with the trapezoidal rule: half with the
 * forces before, half with those after each drift. Sums are exact (ExactSum),
 * so that they do not depend on the number of ranks.
 */
class HaloForces
{
public:
  AlignedVector<Vec> normal, friction; // per slot [N]
  PairForces pairs; // of more than two bodies: who pushes whom

  /** For a halo of @p n slots; all forces zero. Work and impulses so far
      stay. */
  void resize(const std::size_t n);
  /** All forces zero. */
  void clear();
  /** Adds normal + friction of the owned nodes to their bodies' forces. */
  void add_to_bodies(const NodeHalo &halo);
  /** Work of the present forces along @p half_dt times the bodies' present
      velocities, on owned nodes, and their impulse, which is what the half kick
      beside it gives. */
  void accumulate_work(const NodeHalo &halo, const double half_dt);
  /** What the forces took from the bodies, this rank's share: -W, so that
      stored and dissipated energy are positive. */
  void add_energies(EnergyLedger &ledger) const;
  /** Appends "contact energy" and "friction energy" [J]. Collective, the same
      on all ranks. */
  void add_measures(Measures &measures, MPI_Comm communicator) const;
  /** What acts on each body of @p body_pairs, of more than two by each other
      one (PairForces); of two on each that is not met by itself alone, and
      @p with_own on that, too: where it meets its mirror images; named
      @p source. Collective. */
  std::vector<Resultant>
  resultants(const std::string &source,
             const std::vector<std::pair<int, int>> &body_pairs,
             const NodeHalo &halo, MPI_Comm communicator,
             const bool with_own = false) const;
  /** After resize(): forces are part of the state, for half of their work along
      the next step is still to be counted. @p slots: those of the halo. */
  void visit_state(StateVisitor &visitor, const NodeHalo &halo,
                   const StateItems &slots);

private:
  /** Nothing yet on the owned slots of a new halo. */
  void start_impulses(const NodeHalo &halo);
  /** To the bodies' sums: what the slots of the last halo got. */
  void settle_impulses();

  AlignedVector<Vec> total;             // normal + friction, per slot [N]
  ExactSum contact_work, friction_work; // on owned nodes [J]
  /** Impulse of each owned slot since the halo was built, cheap as it is summed
      in every step, and its body; of earlier halos, by body. */
  AlignedVector<Vec> impulse; // [N s]
  std::vector<std::int32_t> body_of;
  std::vector<ExactVectorSum> settled;
};
} // namespace sabot

#endif
