#ifndef sabot_loads_nodal_forces_h
#define sabot_loads_nodal_forces_h

#include "sabot/base/ledger.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"

#include <cstddef>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Forces of a load on some owned nodes of one body, and the work that they do.
 * The forces are kept, as those of the last step do work along the first half
 * of the next one. Work is summed per node, so that it costs little and is the
 * same on any number of ranks. No function is collective but for resultant().
 */
class NodalForces
{
public:
  /** On owned nodes of @p body, local numbers, ascending. */
  NodalForces(Body &body, std::vector<std::size_t> nodes);
  /** On all owned nodes of @p body, those that it gains, too. */
  explicit NodalForces(Body &body);

  /** Take in the nodes that a body on all of which it acts has gained: without
      force, work and impulse so far. */
  void follow_body();

  /** Add the forces to those of the body. */
  void add();
  /** Along @p half_dt [s] with the present velocities, half_dt f . v each. */
  void accumulate_work(const double half_dt);
  /** Work done so far [J], of owned nodes. */
  void add_energies(EnergyLedger &ledger) const;
  void visit_state(StateVisitor &visitor);
  /** Work so far, of owned nodes [J]. */
  ExactSum total_work() const;
  /** Their sum and that of their impulses, as of the load @p name.
      Collective. */
  Resultant resultant(const std::string &name, MPI_Comm communicator) const;

  Body &body;
  std::vector<std::size_t> nodes;
  AlignedVector<Vec> force; // [N], parallel to nodes

private:
  bool is_on_all = false;
  std::vector<double> work;   // [J], parallel to nodes
  AlignedVector<Vec> impulse; // [N s], parallel to nodes
};
} // namespace sabot

#endif
