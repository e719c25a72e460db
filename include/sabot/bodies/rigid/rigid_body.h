#ifndef sabot_bodies_rigid_rigid_body_h
#define sabot_bodies_rigid_rigid_body_h

#include "sabot/bodies/body.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/geometry/local_part.h"
#include "sabot/materials/material.h"

#include <memory>

namespace sabot
{
class Parameters;
}

namespace sabot
{
/** What a scene says about a rigid body, beside shape, material and name.
    Vectors in the fixed frame; the rotation vector is about the center of
    mass. */
struct RigidOptions
{
  /** Prescribed: the initial velocities for ever, whatever the forces. The
      work that keeps them up counts as external. */
  bool is_prescribed = false;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  double cell_size = 0.; // that the mesh was asked for [m]
  std::array<double, 3> angular_velocity{{0., 0., 0.}}; // [1/s], at the start

  /** The entries of the body's subsection; "Initial velocity" is read by the
      body's builder. */
  static void declare_parameters(Parameters &prm);
  static RigidOptions parse(const Parameters &prm);
};

/**
 * A rigid body with the nodes and the surface of a hexahedral mesh. Mass,
 * center and inertia are those of the nodes' lumped masses. Its state is the
 * center c, the rotation Q, the momentum p and the spatial angular momentum l
 * about the center:
 *
 *   p += sum f dt/2, l += sum r x f dt/2 (kicks),
 *   c += dt p/m, Q <- exp(dt omega) Q, omega = Qm I^-1 Qm^T l,
 *
 * with Qm half way (implicit midpoint, four iterations): without forces l is
 * constant and the energy oscillates by O((omega dt)^2) without drift
 * (doc/theory-fem.md). Every rank knows the whole state.
 *
 * Q as a unit quaternion (w, x, y, z), renormalized every step. The density
 * gives mass and the modulus contact's stiffness; there is no stress. Impulses
 * are summed exactly over ranks, so that all have the same bits.
 */
class RigidBody : public Body, public FaceView, public LoadView
{
public:
  /** Mass, center and tensor of inertia of the whole mesh, so that every rank
      has the same to the last bit. Of the material only the density counts. */
  RigidBody(const std::string &name, const int id, HexMesh mesh,
            std::shared_ptr<const Material> material,
            const RigidOptions &options);

  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    return mesh.nodes;
  }
  /** Nodes of a rigid body have contact only, no cells to compute. */
  double partition_weight() const override { return 0.2; }
  /** Arms r of the local nodes in the initial frame, faces whose nodes are
      all here; the mesh is released. */
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  /** Takes up what the last kick did to the nodes, and moves them rigidly.
      sum m_a dv_a goes into p, sum (x_a - c) x m_a dv_a into l, dv_a what
      has been added to the rigid velocity since the last call; a prescribed
      body ignores it. Collective. */
  void impose_velocities(const double time) override;
  /** Of a prescribed motion, -sum f . v dt/2 over the owned nodes [J]: what
      keeps the body going does this work. */
  void accumulate_work(const double half_dt) override;
  /** Nothing: every rank moves all of its nodes by the state it knows. */
  void update_ghosts() override {}
  /** Moves the body by @p dt and clears the forces, which the couplings then
      add. */
  void compute_forces(const double time, const double dt) override;
  /** A twentieth of a radian of rotation, for the midpoint rule; contact
      bounds the step by its own. [s]; the largest double for a body that
      does not turn. */
  StableStep stable_step() const override;
  bool update_topology(const unsigned int, const double) override
  {
    return false;
  }

  /** Kinetic energy of the owned nodes [J], which adds up to
      p^2/(2 m) + omega . l/2, and the work of a prescribed motion on them. */
  void add_energies(EnergyLedger &ledger) const override;
  /** Beside those of the nodes the angular velocity [1/s] in the fixed
      frame. Collective. */
  BodyMeasures measure() const override;
  BodyFacts facts() const override;
  std::vector<Resultant> reactions() const override;
  bool is_held() const override { return is_prescribed; }
  bool prescribe_rigid_motion() override
  {
    is_prescribed = true;
    return true;
  }
  /** Of a prescribed body; every rank gives the same. */
  void move_rigidly(const Vec velocity, const Vec angular_velocity,
                    const bool is_start) override;
  /** dt^2/8 (F . F/m + T . I^-1 T) with the force and the torque about the
      center; none of a prescribed motion. */
  void add_kick_energy(const double dt, ExactSum &sum) const override;
  void visit_state(StateVisitor &visitor) override;
  /** All boundary faces of the mesh that are complete here; the spacing is
      the root of the mean area [m] of all, on every rank. */
  ContactSurface contact_surface() const override;
  LoadedSurface
  loaded_surface(const std::vector<unsigned int> &ids) const override;
  const FaceView *faces() const override { return this; }
  LoadView *loadable() override { return this; }
  std::vector<std::array<std::size_t, 8>> cells_behind_faces() const override
  {
    return {};
  }
  /** So it leads no tie and does not fold. */
  bool deform() const override { return false; }
  bool moves_node_by_node() const override { return false; }

  std::string item_name() const override { return "cells"; }
  GlobalIndex n_items() const override { return n_global_cells; }
  std::string step_timer_name() const override { return "rigid step"; }

  // For verification problems.
  double total_mass() const { return mass; }
  /** About the center, in the initial frame [kg m^2]. */
  const Mat &inertia_tensor() const { return inertia; }

protected:
  void fill_output(OutputMesh &mesh) const override;

private:
  /** omega = Q I^-1 Q^T l for the rotation Q [1/s]. Of a prescribed body the
      one that is prescribed. */
  Vec spin(const Mat &rotation) const;
  /** Faces whose nodes are all here, and the mean edge of all faces. Ids of
      faces are their numbers in the mesh. */
  void take_faces(const LocalPart &part);
  /** Rigid motion of the owned nodes, v = p/m + omega x r. Ghosts as well;
      the owned ones are kept for the impulse of the next kick. */
  void set_velocities();
  /** Rotation by a unit quaternion (w, x, y, z). From the initial to the
      present frame. */
  static Mat matrix(const std::array<double, 4> &quaternion);

  HexMesh mesh; // released after distribute()
  const std::shared_ptr<const Material> material;
  const RigidOptions options;
  MPI_Comm communicator = MPI_COMM_SELF;
  GlobalIndex n_global_cells = 0;
  std::vector<std::array<std::uint32_t, 8>> cells; // with an owned node
  std::vector<char> owned_cell;
  std::vector<std::array<std::size_t, 4>> boundary_faces;
  std::vector<GlobalIndex> face_id;
  struct Boundary
  {
    std::vector<unsigned int> id;      // of the faces
    std::vector<double> edge_distance; // of local nodes [m]
  } boundary;
  double typical_spacing = 0.;

  double mass = 0.;                // [kg]
  Mat inertia, inverse_inertia;    // initial frame
  AlignedVector<Vec> arm;          // of all local nodes, initial frame [m]
  std::vector<double> node_masses; // of all nodes, until distribute()
  // The same on every rank
  Vec center, momentum, angular_momentum;
  std::array<double, 4> quaternion{{1., 0., 0., 0.}};
  AlignedVector<Vec> rigid_velocity; // of owned nodes, before the kick
  ExactSum work;                     // of a prescribed motion [J]
  ExactVectorSum impulse;            // of what keeps it up [N s]
  bool is_prescribed;                // by the scene or a load
  Vec prescribed_spin;               // [1/s]
};
} // namespace sabot

#endif
