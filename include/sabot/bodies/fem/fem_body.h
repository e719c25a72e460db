#ifndef sabot_bodies_fem_fem_body_h
#define sabot_bodies_fem_fem_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/fem/fem_boundary.h"
#include "sabot/bodies/fem/fem_conversion.h"
#include "sabot/bodies/fem/fem_erosion.h"
#include "sabot/bodies/fem/heat_conduction.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/fem/living_cells.h"
#include "sabot/bodies/scaled_body.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/geometry/local_part.h"
#include "sabot/materials/material.h"

#include <memory>
#include <unordered_map>

namespace sabot
{
/**
 * A body of hexahedra on this rank: its nodes, the life of a step and reports.
 * What its cells do is up to Hexahedra, what can be touched to FemBoundary,
 * which cells go to FemErosion and FemConversion, temperatures between cells to
 * HeatConduction.
 *
 * A step: accelerations by M a = f_external - f_internal with lumped masses (an
 * eighth of the mass of every cell around), where the internal forces are
 * -sum_cells V_0 J sigma F^-T B_a at the positions now (doc/theory).
 * Nodes: owned ones first, then ghosts, both ascending in global order.
 *
 * Units are SI, vectors and tensors in the fixed frame. A node belongs to one
 * rank; a cell is computed by every rank that owns one of its nodes and
 * reported by one. Sums over ranks are exact (ExactSum), so reports are the
 * same for every number of ranks.
 */
class FemBody : public ScaledBody, public FaceView, public MemoryView
{
public:
  /** @p mesh and @p material are complete; nothing is collective. Throws
      InputError, by the entry of the body, for erosion by a state that the
      material does not have, for conduction without conductivity or together
      with erosion, and for symmetry faces that are not plane. */
  FemBody(const std::string &name, const int id, HexMesh mesh,
          std::shared_ptr<const Material> material, const FemOptions &options);

  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    return mesh.nodes;
  }
  /** The unit of cost: a node of one-point cells. */
  double partition_weight() const override { return 1.; }
  /** Takes the nodes of this rank and all cells around them, lumps masses
      m_a = sum rho V_0/8 in global cell order, so that they are the same on
      every rank that has the node, and releases the mesh. Collective. */
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  // Between the kicks and drifts of the integrator, see Body.
  /** Held components get the prescribed velocity [m/s], 0 on clamped faces
      and across symmetry planes. Local. */
  void impose_velocities(const double time) override;
  /** Adds -dt/2 f . v of the driven components [J], the work that a drive
      does against the forces f on its nodes; half a step at a time, before
      and after the forces change. Local. */
  void accumulate_work(const double half_dt) override;
  /** Positions and velocities of the nodes of other ranks: all that the cells
     of this one need. Forces are never exchanged, as every rank computes all
     cells of its nodes. */
  void update_ghosts() override;
  /** Forces -f_internal [N] at the positions now, from zero; material
      advanced by dt [s]. Local, but may throw PhysicsError on one rank (an
      inverted cell). */
  void compute_forces(const double time, const double dt) override;
  /** The least of the cells' (by bounds of their highest frequencies),
     shortened by bulk viscosity and stiffening of the material. */
  StableStep stable_step() const override;
  /** Heat conduction where its interval is over, then erosion; only the latter
      changes forces and surface. Collective. */
  bool update_topology(const unsigned int step, const double time) override;

  /** Owned cells only, so that the sum over ranks counts each once; the kinetic
      energy of nodes that lost all cells counts as eroded. */
  void add_energies(EnergyLedger &ledger) const override;
  /** Energies and momentum of the body, the largest plastic strain and
      temperature, what has been eroded. Collective; exact sums, the same for
      every number of ranks. */
  BodyMeasures measure() const override;
  BodyFacts facts() const override;
  /** By any clamped, driven or symmetry face, the rest of the scene aside. */
  bool is_held() const override;
  std::vector<SymmetryPlane> planes_of_symmetry() const override
  {
    return boundary.planes();
  }
  /** Center of every owned cell, and its effective plastic strain. */
  std::vector<MaterialSite> material_sites() const override;
  /** Eroded cells first: a reader must take them out before it fills arrays.
      External work is part of it. */
  void visit_state(StateVisitor &visitor) override;
  void list_memory(MemoryTable &table) const override;

  /** Faces whose four nodes are all here, owned nodes of them; none on
      planes of symmetry. Local. */
  ContactSurface contact_surface() const override;
  /** Goes up whenever cells erode; couplings search anew when it does. */
  unsigned int contact_surface_version() const override
  {
    return surface_version;
  }

  // The view of its faces.
  const FaceView *faces() const override { return this; }
  LoadView *loadable() override { return &boundary; }
  CellSource *cell_source() override { return &conversion; }
  /** Local nodes in VTK order of the cell behind each face of
      contact_surface(); zeros where this rank does not have it. */
  std::vector<std::array<std::size_t, 8>> cells_behind_faces() const override;
  bool deform() const override { return true; }
  void add_section_force(const Vec normal, const double offset,
                         ExactVectorSum &sum) const override;
  std::vector<double>
  flow_stress(const std::vector<std::size_t> &some_nodes) const override;

  std::string item_name() const override { return "cells"; }
  GlobalIndex n_items() const override { return n_global_cells; }
  std::string step_timer_name() const override { return "fem step"; }

  // For tests and verification problems.
  std::size_t n_local_cells() const { return cells->size(); }
  double stress(const std::size_t component, const std::size_t cell) const
  {
    return cells->stress(component, cell);
  }
  std::vector<double> cell_state(const std::string &variable) const
  {
    return cells->cell_state(variable);
  }
  void shift_state(const std::string &variable,
                   const std::vector<double> &change)
  {
    cells->shift_state(variable, change);
  }

protected:
  /** Owned cells with all their nodes, so that borders between ranks are drawn
      by one of them. */
  void fill_output(OutputMesh &mesh) const override;

private:
  /** Whether the material has this state variable. Asked of the law, not of
      the arrays, so that ranks without cells answer alike. */
  bool has_state(const std::string &variable) const;
  /** Conducts since the last time that it was called; collective. Cells'
      mean temperatures go through HeatConduction; every point gets its
      cell's change [K]. */
  void conduct_heat(const double time);
  /** The nodes of this rank at rest in place, and their exchange. Velocities
      are the initial ones [m/s], masses 0 until cells add theirs.
      Collective: owners learn who asks for what. */
  void lay_out_nodes(const LocalPart &part, const std::vector<int> &owner);
  /** Cells behind the boundary faces, FemBoundary::no_cell where another rank's
      nodes have it. Kept once found, unless cells erode. */
  const std::vector<std::uint32_t> &cell_of_faces() const;
  /** Which owned nodes lost all their cells; null where none erodes. [n_owned].
      Such nodes keep mass and momentum; they count as eroded. */
  const std::vector<char> *free_nodes() const;

  HexMesh mesh; // released after distribute()
  std::shared_ptr<const Material> material;
  const FemOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global_cells = 0;
  GhostExchange node_exchange;
  std::unique_ptr<Hexahedra> cells; // of this rank's nodes, ascending
  std::vector<char> owned_cell;     // whether this rank reports it, [cells]
  VelocityConstraints constraints;
  FemBoundary boundary;
  mutable std::vector<std::uint32_t> known_cell_of_faces;
  unsigned int surface_version = 0;    // the same on every rank
  std::unique_ptr<LivingCells> living; // only where cells may go
  std::unique_ptr<FemErosion> erosion; // only where cells may erode
  FemConversion conversion;
  std::unique_ptr<HeatConduction> heat; // only where asked for
  double last_conduction = 0.;          // [s]
};
} // namespace sabot

#endif
