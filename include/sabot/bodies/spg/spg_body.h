#ifndef sabot_bodies_spg_spg_body_h
#define sabot_bodies_spg_spg_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/particle_cloud.h"
#include "sabot/materials/material.h"

#include <memory>

namespace dealii
{
class ParameterHandler;
}

namespace sabot
{
/** Settings of a smoothed-particle-Galerkin body; defaults are those of the
    reference paper where it gives one. */
struct SpgOptions
{
  double normalized_support = 2.0;          // kernel radius over spacing
  double stabilization_coefficient = 4.0;   // alpha of the bond residual
  unsigned int kernel_update_interval = 30; // steps
  unsigned int failure_check_interval = 5;  // steps
  double critical_effective_plastic_strain = 1e10;
  double critical_stretch = 1.0;
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  std::uint8_t symmetry_faces = 0; // bits as in ParticleCloud::on_face

  static void declare_parameters(dealii::ParameterHandler &prm);
  static SpgOptions parse(const dealii::ParameterHandler &prm);
};

/**
 * Particles with least-squares (linearly corrected) approximation, direct
 * nodal integration, bond-residual stabilisation with history, an adaptive
 * anisotropic Lagrangian kernel and irreversible bond failure. Derivation:
 * doc/theory-spg.md. With N a particle, J its neighbours, X the configuration
 * of the last kernel update, dX = X_J - X_N, dx likewise now:
 *
 *   M_N = sum phi dX (x) dX,  F_N = 1 + [sum phi (dx - dX) (x) dX] M_N^-1,
 *   e_NJ = dx - F_N Xi_NJ,    t_NJ = theta_N k_N phi e_NJ,
 *   Q_N = (V_N P_N - sum t_NJ (x) Xi_NJ) M_N^-1,
 *   f_N = sum_J [phi (Q_N + Q_J) dX + t_NJ - t_JN].
 *
 * Every particle gathers its own force, neighbours in global order, so results
 * do not depend on the number of ranks.
 */
class SpgBody : public Body
{
public:
  SpgBody(const std::string &name, const int id, ParticleCloud cloud,
          std::shared_ptr<const Material> material, const SpgOptions &options);

  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    return cloud.position;
  }
  double partition_weight() const override { return 4.; }
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  void impose_velocities(const double) override
  {
    constraints.impose(nodal_state);
  }
  void update_ghosts() override;
  void compute_forces(const double time, const double dt) override;
  StableStep stable_step() const override;
  void update_topology(const unsigned int step, const double time) override;

  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;

  ContactSurface contact_surface() const override;
  DebrisView debris() const override;
  bool are_bonded(const std::size_t i, const GlobalIndex j) const override;

  std::string item_name() const override { return "particles"; }
  GlobalIndex n_items() const override { return n_global; }
  std::string step_timer_name() const override { return "spg step"; }

  /** Local indices of owned particles on the faces of @p faces (bits as in
      ParticleCloud::on_face). */
  std::vector<std::size_t> particles_on_faces(const std::uint8_t faces) const;

  // For tests and verification problems.
  const BondList &bond_list() const { return bonds; }
  Mat deformation_gradient(const std::size_t i) const
  {
    return gradient[i] * total_gradient[i];
  }
  double stress(const std::size_t component, const std::size_t i) const
  {
    return stress_data[component * nodal_state.n_owned + i];
  }

private:
  void set_up_kernel();
  void update_kernel();
  /** Mark in failed[] the bonds whose criteria are met now. Collective.
      @return whether there are any on this rank. */
  bool find_failed_bonds();
  std::size_t fail_bonds();
  void compute_moments();
  void estimate_stable_step();
  void gradients(const std::size_t begin, const std::size_t end,
                 const double dt, std::string &problem);
  void stresses(const std::size_t begin, const std::size_t end,
                const double dt);
  void residuals(const std::size_t begin, const std::size_t end);
  void generalized_stresses(const std::size_t begin, const std::size_t end);
  void gather_forces();
  const double *state_array(const std::string &name) const;

  static constexpr std::size_t batch_size = 64;
  /** Fraction of the intact middle eigenvalue of the moment matrix below which
      a direction counts as lost (prototype: 0.15, see doc/theory-spg.md). */
  static constexpr double lost_direction = 0.15;

  ParticleCloud cloud; // positions and volumes released after distribute()
  std::shared_ptr<const Material> material;
  const SpgOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global = 0;
  std::array<double, 3> spacing;
  double mean_spacing = 0.;
  GhostExchange node_exchange;
  BondList bonds;

  // Owned and ghost particles
  AlignedVector<Vec> kernel_position;    // X of the last kernel update
  AlignedVector<Mat> generalized_stress; // Q
  AlignedVector<Mat> kernel;             // H, columns: semi-axes
  std::vector<double> plastic_strain_copy;
  std::vector<char> failed; // per bond, during an update

  // Owned particles
  std::vector<std::uint8_t> on_face;
  VelocityConstraints constraints; // symmetry planes
  std::vector<double> reference_volume, kernel_volume;
  AlignedVector<Mat> gradient;       // F since the last kernel update
  AlignedVector<Mat> total_gradient; // F up to the last kernel update
  AlignedVector<Mat> moment_inverse;
  std::vector<double> bond_stiffness;    // k_N = alpha mu V_N / S_N
  std::vector<double> intact_eigenvalue; // of the intact moment matrix
  std::vector<double> intact_spread;     // S_N of the intact neighbourhood
  std::vector<char> weak;                // a direction is lost
  std::vector<char> has_failed_bond;
  std::vector<double> stress_data;      // [6][n_owned]
  std::vector<double> state_data;       // [n_states][n_owned]
  std::vector<double> viscous_pressure; // of the last step [Pa]
  std::vector<double> internal_energy, bond_work, plastic_work; // [J]
  std::vector<double> force_on_residual;  // sum t . e of the last step [J]
  std::vector<double> update_stable_step; // [s] at the last kernel update
  double current_stable_step = 0.;
  GlobalIndex stable_step_item = -1;
  double largest_change = 0.; // how far det F left 1, as a ratio >= 1
  std::size_t n_removed_bonds = 0;
  std::vector<StateVariable> state_variables;
  std::size_t n_states = 0;

  /** Work arrays of one batch. */
  struct Batch
  {
    double strain[6][batch_size], spin[3][batch_size];
    double jacobian[batch_size], half_volume[batch_size];
    double viscous_pressure[batch_size];
    double extra_square[batch_size];
    double trial_residual[batch_size]; // sum k phi |e|^2 [J]
    double old_force_on_residual[batch_size];
    double return_factor[batch_size], plastic_work[batch_size];
    Mat nominal[batch_size];
  };
  Batch batch;
  std::vector<double *> batch_states; // one pointer per state array
};
} // namespace sabot

#endif
