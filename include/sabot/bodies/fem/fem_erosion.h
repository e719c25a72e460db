#ifndef sabot_bodies_fem_fem_erosion_h
#define sabot_bodies_fem_fem_erosion_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/fem/living_cells.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
/**
 * Erosion: cells that meet a criterion are taken out of the body, with their
 * energy, which the ledger keeps as eroded. Their nodes stay; those that lose
 * all cells fly on as free mass.
 *
 * Every rank that has a cell condemns it by the same values, so no list of dead
 * cells is exchanged: only whether there are any. Books count owned cells alone
 * and are exact sums.
 */
class FemErosion
{
public:
  /** Everything refers to the body that erodes and outlives this object.
      @param owned_cell  of active cells, those that this rank reports */
  FemErosion(const FemOptions &options, const Material &material,
             NodalState &nodes, Hexahedra &cells, LivingCells &living,
             std::vector<char> &owned_cell, MPI_Comm communicator);

  /** Erode what meets a criterion: a limit of a state variable, a stable
      step of a cell that is too short, or a cell about to turn inside out.
      The nodal forces lose the dead cells' part. Collective. @return whether
      any rank has eroded a cell. Cells die between steps. Limits are
      compared with means over a cell's points; "reached" is enough. */
  bool erode();

  /** Internal and hourglass energy of the dead as eroded; their plastic work
      stays plastic work [J]. Local. */
  void add_energies(EnergyLedger &ledger) const;
  /** Mass, energy and momentum of what has gone. Collective. */
  void add_measures(BodyMeasures &measures) const;
  void visit_state(StateVisitor &visitor);

private:
  /** Active cells that meet a criterion, ascending. */
  std::vector<std::size_t> find_condemned() const;
  /** Books and removes them. Energies, mass rho V_0 and number of the owned
      ones. */
  void remove(const std::vector<std::size_t> &condemned);

  const FemOptions &options;
  const Material &material;
  NodalState &nodal_state;
  Hexahedra &cells;
  LivingCells &living;
  std::vector<char> &owned_cell;
  MPI_Comm communicator;

  ExactSum mass, energy, plastic_work, n_cells; // eroded, of owned cells
};
} // namespace sabot

#endif
