#ifndef sabot_bodies_fem_fem_body_h
#define sabot_bodies_fem_fem_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/materials/material.h"

#include <memory>
#include <unordered_map>

namespace dealii
{
class ParameterHandler;
}

namespace sabot
{
struct FemOptions
{
  static constexpr double never = 1e10;
  enum class Hourglass
  {
    viscous,
    stiffness
  };
  Hourglass hourglass = Hourglass::viscous;
  double hourglass_coefficient = 0.1;
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  /** A cell is eroded when one of these is passed; never by default. */
  double erosion_plastic_strain = never, erosion_damage = never;
  double erosion_step = 0.; // [s], the cell's own stable step falls below
  /** What to do with a cell that the last step brought half way to a volume of
      zero: two more like it would turn it inside out. */
  enum class Inversion
  {
    stop,
    erode,
    shrink // no step may take more than a quarter of a cell's volume
  };
  Inversion inversion = Inversion::stop;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  std::vector<unsigned int> clamped_boundary_ids, symmetry_boundary_ids,
      driven_boundary_ids;
  /** Of the nodes of driven faces; only the held components count. */
  std::array<double, 3> driven_velocity{{0., 0., 0.}}; // [m/s]
  std::array<bool, 3> driven_components{{true, true, true}};

  bool erodes() const
  {
    return erosion_plastic_strain < never || erosion_damage < never ||
           erosion_step > 0. || inversion == Inversion::erode;
  }

  static void declare_parameters(dealii::ParameterHandler &prm);
  static FemOptions parse(const dealii::ParameterHandler &prm);
};

/**
 * One-point hexahedra with Flanagan-Belytschko hourglass control, in total
 * Lagrangian form (doc/theory-fem.md): with the mean gradients B_a of the
 * reference configuration,
 *
 *   F = sum x_a (x) B_a,  f_a = -V_0 J sigma F^-T B_a - hourglass,
 *   gamma_a = h_a - sum_b (h_b X_b) . B_a,  q = sum gamma_a x_a
 *
 * for stiffness control; viscous control takes gamma and q' = sum gamma_a v_a
 * in the present configuration, where sum gamma_a x_a = 0 (no torque).
 *
 * A rank holds every cell of its nodes (those at its border are computed by
 * several ranks alike) and adds up corner forces in global cell order: forces
 * need no exchange and do not depend on the number of ranks.
 */
class FemBody : public Body
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
  void update_topology(const unsigned int step, const double time) override;

  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;

  ContactSurface contact_surface() const override;
  unsigned int contact_surface_version() const override
  {
    return surface_version;
  }

  std::string item_name() const override { return "cells"; }
  GlobalIndex n_items() const override { return n_global_cells; }
  std::string step_timer_name() const override { return "fem step"; }

  // For tests and verification problems.
  std::size_t n_local_cells() const { return connectivity.size(); }
  double stress(const std::size_t component, const std::size_t cell) const
  {
    return stress_data[component * n_local_cells() + cell];
  }
  const double *state_array(const std::string &name) const;

private:
  /** Axis of the normal of the faces with boundary id @p id; throws InputError
      unless they lie in one plane across an axis. */
  int symmetry_axis(const unsigned int id) const;
  void
  set_up_boundary(const std::unordered_map<GlobalIndex, std::uint32_t> &local);
  // fem_erosion.cc
  void set_up_erosion();
  /** Active cells that meet a criterion, ascending. */
  std::vector<std::size_t> cells_to_erode() const;
  /** The cell's part of the nodal forces as they are now. */
  void cell_forces(const std::size_t cell, Vec force[8]) const;
  void erode(const std::vector<std::size_t> &cells);
  void update_boundary(const std::vector<std::uint32_t> &dead);
  /** Drop the active cells whose initial cell is dead from all arrays. */
  void compact();
  void add_erosion_measures(Measures &measures) const;
  /** Which owned nodes lost all their cells; null where none can. */
  const std::vector<char> *free_nodes() const;

  void kinematics(const std::size_t begin, const std::size_t end,
                  const double dt);
  /** Called for a cell that lost a third of its volume, or more, in a step to
      the gradient @p F. @return the gradient to go on with. */
  Mat avoid_inversion(const std::size_t cell, const Mat &F);
  void stresses(const std::size_t begin, const std::size_t end,
                const double dt);
  void scatter_forces(const std::size_t begin, const std::size_t end,
                      const double dt);
  /** Of the stiffness form [N/m], at det F = @p J. */
  double hourglass_stiffness(const std::size_t cell, const double J) const;
  /** 2 / omega without viscosity [s]; @p thickness: smallest dimension [m]. */
  double cell_stable_step(const std::size_t cell, const Mat &F_inverse,
                          const double J, double &thickness) const;

  static constexpr std::size_t batch_size = 64;
  /** Reference data of a cell, read once per step in this order. */
  struct CellGeometry
  {
    Vec mean_gradient[8];
    Mat gradient_square; // sum_a B_a (x) B_a, for the stable step
  };
  /** Per hourglass mode; stiffness control: sum_b h_b X_b, viscous control:
      the modal force of the last step, for its work. */
  struct HourglassModes
  {
    Vec mode[4];
  };

  HexMesh mesh; // released after distribute()
  std::shared_ptr<const Material> material;
  const FemOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global_cells = 0;
  GhostExchange node_exchange;
  std::vector<StateVariable> state_variables;
  std::size_t n_states = 0;

  // Cells of this rank's nodes, ascending
  std::vector<std::array<std::uint32_t, 8>> connectivity;
  AlignedVector<CellGeometry> geometry;
  AlignedVector<HourglassModes> hourglass_modes;
  AlignedVector<Mat> gradient;          // F
  std::vector<double> viscous_pressure; // of the last step [Pa]
  std::vector<double> volume;           // V_0 [m^3]
  std::vector<GlobalIndex> cell_id;
  std::vector<char> owned_cell;
  std::vector<double> stress_data, state_data;
  std::vector<double> internal_energy, hourglass_energy, plastic_work; // [J]
  VelocityConstraints constraints;
  std::map<unsigned int, int> symmetry_axes; // of boundary ids
  /** Symmetry planes through owned nodes that lie on any. */
  std::map<std::size_t, int> n_symmetry_planes;
  std::vector<std::array<std::size_t, 4>> boundary_faces;
  std::vector<GlobalIndex> boundary_face_id;
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
    std::vector<char> free_node;        // owned, lost all cells
    std::vector<double> step;           // of active cells [s], when asked for
    std::vector<std::size_t> inverting; // active cells, in this step
    GlobalIndex n_boundary_faces = 0;   // of the whole mesh
    ExactSum mass, energy, plastic_work, n_cells; // eroded, of owned cells
  };
  std::unique_ptr<Erosion> erosion;
  double current_stable_step = 0.;
  GlobalIndex stable_step_item = -1;

  struct Batch
  {
    double strain[6][batch_size], spin[3][batch_size];
    double jacobian[batch_size], half_volume[batch_size];
    double viscous_pressure[batch_size];
    double return_factor[batch_size], plastic_work[batch_size];
    Mat inverse_transposed[batch_size];
  };
  Batch batch;
  std::vector<double *> batch_states;
};
} // namespace sabot

#endif
