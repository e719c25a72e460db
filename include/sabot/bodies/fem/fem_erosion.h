#ifndef sabot_bodies_fem_fem_erosion_h
#define sabot_bodies_fem_fem_erosion_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/fem/fem_boundary.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/fem/hexahedra.h"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * Erosion: cells that meet a criterion are taken out of the body, with their
 * energy, which the ledger keeps as eroded. Their nodes stay; those that lose
 * all cells fly on as free mass. Faces of dead cells leave the boundary, faces
 * of the living behind them join it.
 *
 * "Initial" counts this rank's cells as distributed; all arrays of the cells
 * themselves hold the active ones only, in the same order.
 *
 * Every rank that has a cell condemns it by the same values, so no list of dead
 * cells is exchanged: only whether there are any. Books count owned cells alone
 * and are exact sums.
 */
class FemErosion
{
public:
  /** Everything refers to the body that erodes and outlives this object.
      @param owned_cell  of active cells, those that this rank reports
      @param n_boundary_faces  of the whole mesh: ids from there on are new */
  FemErosion(const FemOptions &options, const Material &material,
             NodalState &nodes, Hexahedra &cells, FemBoundary &boundary,
             std::vector<char> &owned_cell, const GlobalIndex n_boundary_faces,
             MPI_Comm communicator);

  /** Erode what meets a criterion: a limit of a state variable, a stable
      step of a cell that is too short, or a cell about to turn inside out.
      The nodal forces lose the dead cells' part. Collective. @return whether
      any rank has eroded a cell. Cells die between steps. Limits are
      compared with means over a cell's points; "reached" is enough. */
  bool erode();

  /** Cells behind the boundary's faces, numbers of active cells. Parallel to
      FemBoundary::faces. */
  std::vector<std::uint32_t> cells_of_faces() const;
  /** Owned nodes that lost all their cells, [n_owned]. */
  const std::vector<char> &free_nodes() const { return free_node; }

  /** Internal and hourglass energy of the dead as eroded; their plastic work
      stays plastic work [J]. Local. */
  void add_energies(EnergyLedger &ledger) const;
  /** Mass, energy and momentum of what has gone. Collective. */
  void add_measures(BodyMeasures &measures) const;
  /** Before the cells' own visit: a reader must know which are left before it
      fills their arrays. */
  void visit_state(StateVisitor &visitor);

private:
  /** Active cells that meet a criterion, ascending. */
  std::vector<std::size_t> find_condemned() const;
  /** Which cells share a face, by its sorted corners; once, before any dies.
      -1 on the surface and where another rank has the cell. Sorting, n log
      n. */
  void find_neighbors();
  /** Books and removes them. Energies, mass rho V_0 and number of the owned
      ones; the nodal forces lose the cells' part first. */
  void remove(const std::vector<std::size_t> &condemned);
  /** Faces that go and come with these initial cells; counts the cells that
      nodes still have. New faces have ids that no other rank or time gives
      to another face. A new face has the id n_boundary_faces + 6 cell +
      side, cell and side those of the living cell behind it; its corners run
      so that the normal points out of that cell. */
  void update_boundary(const std::vector<std::uint32_t> &dead);
  /** Drop the active cells whose initial cell is dead from all arrays. */
  void compact();

  const FemOptions &options;
  const Material &material;
  NodalState &nodal_state;
  Hexahedra &cells;
  FemBoundary &boundary;
  std::vector<char> &owned_cell;
  const GlobalIndex n_boundary_faces;
  MPI_Comm communicator;

  std::vector<std::uint32_t> initial;              // of active cells
  std::vector<char> alive;                         // of initial cells
  std::vector<std::array<std::int32_t, 6>> across; // initial cells or -1
  std::vector<std::array<std::uint32_t, 8>> nodes; // of initial cells
  std::vector<GlobalIndex> id;                     // of initial cells
  std::vector<std::int32_t> face_cell; // initial cell of the boundary's faces
  std::vector<std::uint8_t> cells_of_node;
  std::vector<char> free_node;                  // owned, lost all cells
  ExactSum mass, energy, plastic_work, n_cells; // eroded, of owned cells
};
} // namespace sabot

#endif
