#ifndef sabot_bodies_spg_spg_body_h
#define sabot_bodies_spg_spg_body_h

#include "sabot/base/error.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_conduction.h"
#include "sabot/bodies/spg/second_gradient.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/particle_cloud.h"

#include <memory>

namespace sabot
{
/**
 * Particles with first-order meshfree approximation, direct nodal integration,
 * stabilisation, an adaptive anisotropic Lagrangian kernel and irreversible
 * bond failure. Derivation: doc/theory-spg.md. With N a particle, J its
 * neighbours, X the configuration of the last kernel update, dX = X_J - X_N,
 * dx likewise now, g_NJ the gradient of J's function at N:
 *
 *   F_N = 1 + sum (dx - dX) (x) g_NJ,
 *   f_N = sum_J [ P_N V_N g_NJ - P_J V_J g_JN ] + stabilisation,
 *
 * for least squares g_NJ = phi M_N^-1 dX with M_N = sum phi dX (x) dX, and with
 * Q_N = V_N P_N M_N^-1 simply f_N = sum_J phi (Q_N + Q_J) dX.
 *
 * Every particle gathers its own force, neighbours in global order, so results
 * do not depend on the number of ranks.
 */
class SpgBody : public Body, public ParticleView, public FragmentView
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
  bool update_topology(const unsigned int step, const double time) override;

  void add_energies(EnergyLedger &ledger) const override;
  BodyMeasures measure() const override;
  std::vector<MaterialSite> material_sites() const override;
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;

  ContactSurface contact_surface() const override;
  std::vector<double>
  flow_stress(const std::vector<std::size_t> &some_nodes) const override;
  SurfacePoint surface_point(const std::size_t i) const override;
  VolumePoint volume_point(const std::size_t i) const override;
  DebrisView debris() const override;
  bool are_bonded(const std::size_t i, const GlobalIndex j) const override;
  std::size_t n_bonds() const override;
  const ParticleView *particles() const override { return this; }
  const FragmentView *fragments() const override { return this; }
  std::vector<Fragment> connected_pieces() const override;

  std::string item_name() const override { return "particles"; }
  GlobalIndex n_items() const override { return n_global; }
  std::string step_timer_name() const override { return "spg step"; }

  /** Local indices of owned particles on the faces of @p faces (bits as in
      ParticleCloud::on_face). */
  std::vector<std::size_t> particles_on_faces(const std::uint32_t faces) const;

  /** Largest frequency of the linearised body at rest [rad/s], by @p n
      Lanczos iterations on M^-1 K with elastic moduli in the configuration of
      the last kernel update; from below. Collective. */
  double largest_frequency(const unsigned int n);

  // For tests and verification problems.
  const BondList &bond_list() const { return bonds; }
  Mat deformation_gradient(const std::size_t i) const
  {
    return gradient[i] * total_gradient[i];
  }
  double stress(const std::size_t component, const std::size_t i) const
  {
    return points.stress_row(component)[i];
  }
  void set_stress(const std::size_t component, const std::size_t i,
                  const double value)
  {
    points.stress_row(component)[i] = value;
  }
  void set_state(const std::string &name, const std::size_t i,
                 const double value)
  {
    points.state(name)[i] = value;
  }
  double state(const std::string &name, const std::size_t i) const
  {
    return points.state(name)[i];
  }
  std::size_t n_fallbacks() const { return n_fallback; }
  std::size_t n_kernel_updates() const { return n_updates; }
  bool is_weak(const std::size_t i) const { return weak[i]; }

private:
  using Stabilization = SpgOptions::Stabilization;

  // spg_output.cc
  void visit_bonds(StateVisitor &visitor);

  // spg_body.cc
  void renumber(const BondList::Rows &rows);
  /** Edge of the cube as large as the cell of an owned particle's lattice at
      the start [m]; mean_spacing in a regular lattice. */
  double local_spacing(const std::size_t i) const;
  /** Axes across which owned particle @p i lies on a plane of symmetry, a bit
      each. */
  unsigned int symmetry_axes(const std::size_t i) const;

  // spg_kernel.cc
  void set_up_kernel();
  bool has_strained() const;
  /** Update the kernel; what the body adds to the forces follows. */
  void update_kernel_and_forces(const std::size_t step);
  void update_kernel(const std::size_t step);
  template <typename Kernel>
  void compute_moments();
  void prepare_kernel();

  // spg_convex.cc
  template <typename Kernel>
  void compute_shape_gradients();
  void set_convex_masses();

  // spg_search.cc
  void search_neighbors();

  // spg_body.cc
  void set_up_conduction();
  void conduct_heat(const double time);

  // spg_failure.cc
  void update_failure_measure();
  /** Mark in failed[] the bonds whose criteria are met now. Collective.
      @return whether there are any on this rank. */
  bool find_failed_bonds();
  std::size_t fail_bonds();
  /** Energy of the residuals of an owned particle [J]. */
  double residual_energy(const std::size_t i) const;
  /** Cut the tension of a particle that lost a direction just now; what it
      stored is lost with it. */
  void release_tension(const std::size_t i);
  std::vector<GlobalIndex> fragment_labels() const;

  // spg_step.cc
  void estimate_stable_step();
  void calibrate_stable_step();
  bool calibration_is_due(const std::size_t step) const;
  double least_bound() const;
  void apply_linearized(const AlignedVector<Vec> &motion,
                        AlignedVector<Vec> &force);

  // spg_smoothing.cc
  void smooth_velocities();
  void smoothing_difference(AlignedVector<Vec> &velocity,
                            AlignedVector<Vec> &contribution) const;

  // spg_forces.cc
  void evaluate_forces(const double dt, std::string &problem);
  template <bool stored_gradients, Stabilization stabilization>
  void force_loop(const double dt, std::string &problem);
  template <bool stored_gradients>
  void gradients(const std::size_t begin, const std::size_t end,
                 const double dt, std::string &problem);
  void residuals(const std::size_t begin, const std::size_t end);
  void stresses(const std::size_t begin, const std::size_t end,
                const double dt);
  template <bool stored_gradients, Stabilization stabilization>
  void generalized_stresses(const std::size_t begin, const std::size_t end);
  template <bool stored_gradients, bool has_residuals>
  void gather_forces();

  // spg_cracks.cc
  /** The material's update; particles that lost a direction open cracks before
      they flow. @p points: of the particles from @p begin on. */
  void update_material(const MaterialBatch &step, const std::size_t begin);
  /** Set uncracked_strain of the batch; false where no crack opens. */
  bool open_cracks(const MaterialBatch &points, const std::size_t begin);

  static constexpr std::size_t batch_size = 64;
  /** Fraction of the intact middle eigenvalue of the moment matrix below which
      a direction counts as lost (doc/theory-spg.md). */
  static constexpr double lost_direction = 0.15;

  ParticleCloud cloud; // positions and volumes released after distribute()
  std::shared_ptr<const Material> material;
  const SpgOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global = 0;
  std::array<double, 3> spacing;
  double mean_spacing = 0.;
  std::vector<int> face_axis; // across each boundary id, -1: not a plane
  std::vector<SymmetryPlane> symmetry_planes;
  bool is_regular;          // one kernel at the start for all
  std::vector<int> rank_of; // of every particle, for new neighbours
  GhostExchange node_exchange;
  BondList bonds;

  // Owned and ghost particles
  AlignedVector<Vec> previous_position; // of the last force evaluation
  AlignedVector<Vec> kernel_position;   // X of the last kernel update
  /** Columns of Q (least squares) or V P (convex) in row[]; the fourth lane of
      row[0] is the stiffness of the residuals, theta k. */
  AlignedVector<Mat> generalized_stress;
  AlignedVector<Mat> kernel; // H, columns: semi-axes
  std::vector<double> failure_measure;

  // Per bond, ghosts' bonds included; only for convex functions
  AlignedVector<Vec> shape_gradient;
  std::vector<double> shape_value, own_shape_value;
  std::vector<char> failed; // per bond, during an update

  // Owned particles
  std::vector<std::uint32_t> on_face;
  AlignedVector<Vec> outward;        // at the start, outward_normals()
  VelocityConstraints constraints;   // symmetry planes, clamped faces
  AlignedVector<Mat> initial_kernel; // H of the start, unless regular
  std::vector<double> reference_volume, kernel_volume;
  AlignedVector<Mat> gradient;       // F since the last kernel update
  AlignedVector<Mat> total_gradient; // F up to the last kernel update
  AlignedVector<Mat> moment_inverse;
  std::vector<double> bond_stiffness;    // k_N = alpha mu V_N / S_N
  std::vector<double> residual_factor;   // theta, due on residuals
  std::vector<double> intact_eigenvalue; // of the intact moment matrix
  std::vector<double> intact_spread;     // S_N of the intact neighbourhood
  std::vector<char> weak;                // a direction is lost
  std::vector<std::uint32_t> n_failed;   // bonds, per particle
  std::vector<std::vector<GlobalIndex>> failed_pairs; // only when searching
  MaterialPoints points;
  std::vector<double> stiffening;         // only of materials that stiffen
  std::vector<double> bond_work;          // [J]
  std::vector<double> failure_loss;       // [J], part of the first two
  AlignedVector<Vec> own_force;           // without what couplings added
  std::vector<double> update_stable_step; // [s] at the last kernel update
  double current_stable_step = 0.;
  GlobalIndex stable_step_item = -1;
  /** Proven part by which steps may exceed the Gershgorin bound. */
  double step_calibration = 1.;
  double initial_calibration = std::numeric_limits<double>::max();
  std::size_t last_calibration = 0; // step
  double calibrated_bound = 0.;     // Gershgorin's, at the last calibration [s]
  double largest_change = 0.;       // largest stretch of F or F^-1, squared
  std::size_t n_updates = 0, n_fallback = 0;
  std::unique_ptr<SecondGradient> second_gradient;
  std::unique_ptr<ParticleConduction> heat; // only where asked for
  double last_conduction = 0.;              // [s]

  /** Work arrays of one batch. */
  struct Batch : PointStepArrays<batch_size>
  {
    double extra_square[batch_size];
    // Sums over bonds of phi times: trial square, old with trial, old square
    double trial_square[batch_size], old_trial[batch_size],
        old_square[batch_size];
    // Of batches with particles that lost a direction
    double old_stress[6][batch_size], uncracked_strain[6][batch_size];
    bool is_cracked[batch_size];
    Mat residual_on_bond[batch_size];     // sum phi e (x) dx
    Mat residual_on_residual[batch_size]; // sum phi e (x) e
    Mat velocity_gradient[batch_size];    // F_new F_old^-1 - 1
    Mat nominal[batch_size];              // F^-T
  };
  Batch batch;
  std::vector<double> old_states; // of a batch with cracks
};
} // namespace sabot

#endif
