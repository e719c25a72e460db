#ifndef sabot_bodies_fem_fem_body_h
#define sabot_bodies_fem_fem_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/fem/heat_conduction.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/materials/material.h"

#include <memory>
#include <unordered_map>

namespace sabot
{
/**
 * Nodes, boundary, erosion and reports of a body of hexahedra; what its cells
 * do is up to Hexahedra.
 */
class FemBody : public Body, public FaceView
{
public:
  FemBody(const std::string &name, const int id, HexMesh mesh,
          std::shared_ptr<const Material> material, const FemOptions &options);

  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    return mesh.nodes;
  }
  double partition_weight() const override { return 1.; }
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  void impose_velocities(const double time) override;
  void accumulate_work(const double half_dt) override;
  void update_ghosts() override;
  void compute_forces(const double time, const double dt) override;
  StableStep stable_step() const override;
  bool update_topology(const unsigned int step, const double time) override;

  void add_energies(EnergyLedger &ledger) const override;
  BodyMeasures measure() const override;
  std::vector<MaterialSite> material_sites() const override;
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;

  ContactSurface contact_surface() const override;
  unsigned int contact_surface_version() const override
  {
    return surface_version;
  }

  const FaceView *faces() const override { return this; }
  std::vector<std::array<std::size_t, 8>> cells_behind_faces() const override;
  bool deform() const override { return true; }
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

private:
  /** Whether the material has this state variable. */
  bool has_state(const std::string &variable) const;
  void conduct_heat(const double time);
  /** Axis of the normal of the faces with boundary id @p id; throws InputError
      unless they lie in one plane across an axis. */
  int symmetry_axis(const unsigned int id) const;
  void
  set_up_boundary(const std::unordered_map<GlobalIndex, std::uint32_t> &local);
  /** Cells behind the boundary faces; no_cell where another rank's nodes have
      it. */
  static constexpr std::uint32_t no_cell = -1;
  const std::vector<std::uint32_t> &cell_of_faces() const;
  // fem_erosion.cc
  void set_up_erosion();
  /** Active cells that meet a criterion, ascending. */
  std::vector<std::size_t> cells_to_erode() const;
  /** Erode what meets a criterion. Collective.
      @return whether any rank has eroded a cell. */
  bool erode_cells();
  void erode(const std::vector<std::size_t> &cells);
  void update_boundary(const std::vector<std::uint32_t> &dead);
  /** Drop the active cells whose initial cell is dead from all arrays. */
  void compact();
  void visit_erosion(StateVisitor &visitor);
  void add_erosion_measures(BodyMeasures &measures) const;
  /** Which owned nodes lost all their cells; null where none can. */
  const std::vector<char> *free_nodes() const;

  HexMesh mesh; // released after distribute()
  std::shared_ptr<const Material> material;
  const FemOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global_cells = 0;
  GhostExchange node_exchange;
  std::unique_ptr<Hexahedra> cells; // of this rank's nodes, ascending
  std::vector<char> owned_cell;
  VelocityConstraints constraints;
  std::map<unsigned int, int> symmetry_axes; // of boundary ids
  std::vector<SymmetryPlane> symmetry_planes;
  /** Symmetry planes through owned nodes that lie on any. */
  std::map<std::size_t, int> n_symmetry_planes;
  std::vector<std::array<std::size_t, 4>> boundary_faces;
  std::vector<GlobalIndex> boundary_face_id;
  /** Of boundary_faces; found when asked for, then kept. */
  mutable std::vector<std::uint32_t> known_cell_of_faces;
  double typical_spacing = 0.;
  unsigned int surface_version = 0; // the same on every rank
  /** Present where cells may erode. "Initial" counts this rank's cells as
      distributed; all other arrays of cells hold the active ones only. */
  struct Erosion
  {
    std::vector<std::uint32_t> initial;              // of active cells
    std::vector<char> alive;                         // of initial cells
    std::vector<std::array<std::int32_t, 6>> across; // initial cells or -1
    std::vector<std::array<std::uint32_t, 8>> nodes; // of initial cells
    std::vector<GlobalIndex> id;                     // of initial cells
    std::vector<std::int32_t> face_cell; // initial cell of boundary_faces
    std::vector<std::uint8_t> cells_of_node;
    std::vector<char> free_node;                  // owned, lost all cells
    GlobalIndex n_boundary_faces = 0;             // of the whole mesh
    ExactSum mass, energy, plastic_work, n_cells; // eroded, of owned cells
  };
  std::unique_ptr<Erosion> erosion;
  std::unique_ptr<HeatConduction> heat; // only where asked for
  double last_conduction = 0.;          // [s]
};
} // namespace sabot

#endif
