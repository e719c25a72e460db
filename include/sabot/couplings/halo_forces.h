#ifndef sabot_couplings_halo_forces_h
#define sabot_couplings_halo_forces_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/state_visitor.h"
#include "sabot/couplings/node_halo.h"

namespace sabot
{
/** Normal and friction forces at the slots of a halo, and their work on the
    owned nodes: what all contacts have. */
class HaloForces
{
public:
  AlignedVector<Vec> normal, friction; // per slot [N]

  /** For a halo of @p n slots. */
  void resize(const std::size_t n);
  void clear();
  void add_to_bodies(const NodeHalo &halo);
  void accumulate_work(const NodeHalo &halo, const double half_dt);
  /** What the forces took from the bodies. */
  void add_energies(EnergyLedger &ledger) const;
  /** Contact and friction energy. Collective. */
  void add_measures(Measures &measures, MPI_Comm communicator) const;
  /** After resize(). */
  void visit_state(StateVisitor &visitor);

private:
  AlignedVector<Vec> total;
  ExactSum contact_work, friction_work; // [J]
};
} // namespace sabot

#endif
