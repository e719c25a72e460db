#ifndef sabot_bodies_spg_spg_body_h
#define sabot_bodies_spg_spg_body_h

#include "sabot/base/error.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/scaled_body.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/image_reaction.h"
#include "sabot/bodies/spg/mirror_planes.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/particle_heat.h"
#include "sabot/bodies/spg/particle_intake.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/spg_views.h"
#include "sabot/bodies/spg/stable_step.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/particle_cloud.h"

#include <memory>

namespace sabot
{
/**
 * Particles with first-order meshfree approximation, direct nodal integration,
 * stabilization, an adaptive anisotropic Lagrangian kernel and irreversible
 * bond failure. Derivation: doc/theory-spg.md. With N a particle, J its
 * neighbors, X the configuration of the last kernel update, dX = X_J - X_N,
 * dx likewise now, g_NJ the gradient of J's function at N:
 *
 *   F_N = 1 + sum (dx - dX) (x) g_NJ,
 *   f_N = sum_J [ P_N V_N g_NJ - P_J V_J g_JN ] + stabilization,
 *
 * for least squares g_NJ = phi M_N^-1 dX with M_N = sum phi dX (x) dX, and with
 * Q_N = V_N P_N M_N^-1 simply f_N = sum_J phi (Q_N + Q_J) dX.
 *
 * The body composes rooms of one idea each (SpgParts); the step itself stands
 * in spg_step.h. Every particle gathers its own force, neighbors in global
 * order, so results do not depend on the number of ranks.
 *
 * Nodes are the particles: owned ones by ascending global number, then ghosts.
 * Units are SI; X is a place in the kernel-reference configuration, x in the
 * present one; P = J sigma F^-T with F from X. Momentum is exact as pair terms
 * are equal and opposite, angular momentum as P F^T is symmetric. Equations 16
 * and 18 to 21 of Wu & Wu 2018 are followed for kernel update, weight and
 * failure (doc/theory/spg.md).
 */
class SpgBody : public ScaledBody
{
public:
  /** Throws InputError, by the entry: a failure criterion that the material
      cannot answer, conduction without temperature or conductivity, faces of
      symmetry that are not a plane across an axis. Every rank has the whole
      cloud here. @p lattices: of a body that grows, into which cells of its
      host are split; the cloud is that of the host's nodes. */
  SpgBody(const std::string &name, const int id, ParticleCloud cloud,
          std::shared_ptr<const Material> material, const SpgOptions &options,
          std::shared_ptr<const SplitMesh> lattices = nullptr);

  /** None of a body that grows: its particles are where the host's nodes are.
   */
  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    static const std::vector<std::array<double, 3>> none;
    return options.grows ? none : cloud.position;
  }
  /** Cost of a particle over that of a node of finite elements. */
  double partition_weight() const override { return 4.; }
  /** Owned particles with m = rho V (or row sums of convex functions), bonds
      of the start by the kernels of both ends, functions, stable steps and
      their first calibration. Throws InputError where particles coincide.
      Collective. */
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  /** Zero across planes of symmetry and on clamped faces. Local. */
  void impose_velocities(const double) override
  {
    constraints.impose(nodal_state);
  }
  /** What the own forces of now do across planes of symmetry. Local. */
  void accumulate_work(const double half_dt) override;
  /** Of images beyond planes of symmetry. Collective. */
  std::vector<Resultant> reactions() const override;
  /** Positions only: forces do not ask for ghosts' velocities. Collective. */
  void update_ghosts() override;
  /** Forces of owned particles [N] at the positions now, material advanced
      by dt [s], 0 for forces only. Throws PhysicsError, after the last
      exchange, where a particle has collapsed. Collective. */
  void compute_forces(const double time, const double dt) override;
  /** Least of this rank's particles as of the last forces [s], with the
      global number of the particle. */
  StableStep stable_step() const override;
  /** Looks for failed bonds, updates the kernel where that is due, lets the
      stabilization act between steps and conducts heat. True after a kernel
      update, on all ranks alike: bonds and ghosts may be others then.
      Collective. */
  bool update_topology(const unsigned int step, const double time) override;

  /** Of owned particles [J]: kinetic, internal, stabilization (work done on
      the form), plastic work, failure (what failed bonds and cracks let go).
      Local. */
  void add_energies(EnergyLedger &ledger) const override;
  /** By exact sums. A bond counts half at each end. Weak: particles that
      lost a direction; isolated: those without a bond. Collective. */
  BodyMeasures measure() const override;
  BodyFacts facts() const override;
  /** By faces of symmetry or clamped ones, the rest of the scene aside. */
  bool is_held() const override;
  std::vector<SymmetryPlane> planes_of_symmetry() const override
  {
    return surface.planes();
  }
  /** One per owned particle: place at the start [m], effective plastic
      strain (0 where the law has none), failed fraction of its bonds. */
  std::vector<MaterialSite> material_sites() const override;
  /** Bonds first, since arrays over bonds follow them; where neighbors are
      searched the list itself is state. Collective. */
  void visit_state(StateVisitor &visitor) override;

  void set_internal_friction(const double coefficient) override
  {
    residual_strength->set_internal_friction(coefficient);
  }

  /** All owned particles as nodes, no faces; see ParticleSurface. */
  ContactSurface contact_surface() const override;
  /** Goes up whenever particles have come. */
  unsigned int contact_surface_version() const override
  {
    return intake ? intake->version() : 0;
  }
  const ParticleView *particles() const override { return &views; }
  const FragmentView *fragments() const override { return &views; }
  LoadView *loadable() override { return &surface; }
  ParticleSink *particle_sink() override { return intake.get(); }
  std::vector<double>
  flow_stress(const std::vector<std::size_t> &some_nodes) const override;

  std::string item_name() const override { return "particles"; }
  GlobalIndex n_items() const override { return n_global; }
  std::string step_timer_name() const override { return "spg step"; }

  /** Largest frequency of the linearized body at rest [rad/s], by @p n
      Lanczos iterations on M^-1 K with elastic moduli in the configuration of
      the last kernel update; from below. Collective. */
  double largest_frequency(const unsigned int n);

  // For tests and verification problems: the rooms of owned particles,
  // components of symmetric tensors in the order of n_symmetric.
  const SpgParts &rooms() const { return parts; }
  /** Cauchy stress without bulk viscosity and without the part of a form
      [Pa]. */
  double stress(const std::size_t component, const std::size_t i) const
  {
    return points.stress_row(component)[i];
  }

protected:
  /** Owned particles as vertices. Collective where bonds may fail, for the
      labels of fragments. */
  void fill_output(OutputMesh &mesh) const override;

private:
  /** Number ghosts and bonds by these rows of neighbors; everything that
      belongs to them follows. Collective. A new exchange of particles,
      positions, velocities and masses of ghosts, ghosts' bonds, room in the
      fields, and what the form keeps per bond. Kernels of ghosts are up to
      the caller. */
  void renumber(BondList::Rows rows);
  /** Functions of the present kernels, and what follows from them. At
      kernel_reference_position, with the kernels of owned and ghost
      particles up to date. Collective. */
  void update_functions();
  /** Kernels and functions of the present configuration; failed bonds go,
      and what they held is lost. Collective. Wu & Wu 2018, Eq. 16: F_ref :=
      F_inc F_ref, V and H go by F_inc, X := x, F_inc := 1. A particle that
      lost a direction lets go of the stress that it cannot bear. What the
      form held before less what it holds after counts as failure [J] where
      bonds or directions were lost. Then the stable steps, calibrated where
      that is due. @p only_cracks: nothing else calls for the update, and only
      particles beside cracks get their stable steps anew. */
  void update_kernel(const unsigned int step, const bool only_cracks);
  /** The same, or with @p only_cracks what cracks alone change where that will
      do, with the forces of now in the end. What couplings had added
      to the body's forces is kept: the half kick that follows uses the sum,
      and the ledger counts its work. Collective. */
  void update_kernel_and_forces(const unsigned int step,
                                const bool only_cracks);
  /** Forces of now, material advanced by @p dt; the body's part is kept.
      Collective. own_force is a copy of the result [n_owned], from which
      later what couplings add can be told. */
  void evaluate_forces(const double dt);
  /** Restored rows lead to new ghosts. Collective. */
  void visit_bonds(StateVisitor &visitor);

  ParticleCloud cloud; // released after distribute(), unless the body grows
  const SpgOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global;
  std::vector<int> rank_of; // of every particle, for new neighbors
  ParticleExchange node_exchange;
  BondList bonds;
  VelocityConstraints constraints; // symmetry planes, clamped faces
  ParticleFields fields;
  MaterialPoints points;
  LagrangianKernel kernel;
  ParticleApproximation approximation;
  ParticleSurface surface;
  const MirrorPlanes mirror;
  std::unique_ptr<ImageReaction> reaction; // only with images
  std::unique_ptr<Stabilization> stabilization;
  BondFailure failure;
  std::unique_ptr<ResidualStrength> residual_strength;
  SpgStableStep stable;
  StepWork work;
  StepWatch watch;
  ParticleHeat heat;
  SpgParts parts; // of the above
  SpgViews views;
  std::unique_ptr<ParticleIntake> intake; // only of bodies that grow
};
} // namespace sabot

#endif
