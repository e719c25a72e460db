#ifndef sabot_bodies_fem_fem_body_h
#define sabot_bodies_fem_fem_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/fem/heat_conduction.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/materials/material.h"

#include <memory>

namespace dealii
{
class ParameterHandler;
}

namespace sabot
{
struct FemOptions
{
  enum class Hourglass
  {
    viscous,
    stiffness
  };
  enum class ObjectiveRate
  {
    jaumann,
    green_naghdi
  };
  Hourglass hourglass = Hourglass::viscous;
  ObjectiveRate objective_rate = ObjectiveRate::jaumann;
  double hourglass_coefficient = 0.1;
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  std::vector<unsigned int> clamped_boundary_ids;
  bool conducts_heat = false;
  double conduction_interval = 1e-6; // [s]

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
  void update_ghosts() override;
  void compute_forces(const double time, const double dt) override;
  StableStep stable_step() const override;
  void update_topology(const unsigned int, const double time) override
  {
    if (heat && time >= last_conduction + options.conduction_interval)
      conduct_heat(time);
  }

  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;

  ContactSurface contact_surface() const override;

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
  double *state_array(const std::string &name)
  {
    return const_cast<double *>(
        static_cast<const FemBody &>(*this).state_array(name));
  }

private:
  void conduct_heat(const double time);
  void kinematics(const std::size_t begin, const std::size_t end,
                  const double dt);
  /** Replace the spin increments by those of R, F = R U. */
  void polar_spin(const std::size_t begin, const std::size_t end);
  void stresses(const std::size_t begin, const std::size_t end,
                const double dt);
  /** The step of cells that are stiffer than at rest. */
  void shorten_step(const std::size_t begin, const std::size_t end);
  void scatter_forces(const std::size_t begin, const std::size_t end,
                      const double dt);
  /** 2 / omega without viscosity [s]; @p thickness: smallest dimension [m]. */
  double cell_stable_step(const std::size_t cell, const Mat &F_inverse,
                          const double J, double &thickness) const;

  static constexpr std::size_t batch_size = max_batch_points;
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
  AlignedVector<Mat> polar_rotation;    // R, for the Green-Naghdi rate only
  std::vector<double> viscous_pressure; // of the last step [Pa]
  std::vector<double> volume;           // V_0 [m^3]
  std::vector<GlobalIndex> cell_id;
  std::vector<char> owned_cell;
  std::vector<double> stress_data, state_data;
  std::vector<double> internal_energy, hourglass_energy, plastic_work; // [J]
  std::vector<std::size_t> clamped;
  std::vector<std::array<std::size_t, 4>> boundary_faces;
  std::vector<GlobalIndex> boundary_face_id;
  double typical_spacing = 0.;
  std::unique_ptr<HeatConduction> heat; // only where asked for
  double last_conduction = 0.;          // [s]
  double current_stable_step = 0.;
  GlobalIndex stable_step_item = -1;

  struct Batch
  {
    double strain[6][batch_size], spin[3][batch_size];
    double jacobian[batch_size], half_volume[batch_size];
    double viscous_pressure[batch_size];
    double return_factor[batch_size], plastic_work[batch_size];
    double stable_step[batch_size];
    // For materials that need them
    double mean_viscous_pressure[batch_size], stiffening[batch_size];
    double deformation_gradient[9][batch_size];
    Mat inverse_transposed[batch_size];
  };
  Batch batch;
  std::vector<double *> batch_states;
};
} // namespace sabot

#endif
