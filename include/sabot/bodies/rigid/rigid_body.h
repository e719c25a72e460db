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
/** What a scene says about a rigid body, beside shape, material and name. */
struct RigidOptions
{
  /** Prescribed: the initial velocities for ever, whatever the forces. */
  bool is_prescribed = false;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  double cell_size = 0.; // that the mesh was asked for [m]
  std::array<double, 3> angular_velocity{{0., 0., 0.}}; // [1/s], at the start

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
 */
class RigidBody : public Body, public FaceView
{
public:
  RigidBody(const std::string &name, const int id, HexMesh mesh,
            std::shared_ptr<const Material> material,
            const RigidOptions &options);

  const std::vector<std::array<double, 3>> &partition_points() const override
  {
    return mesh.nodes;
  }
  double partition_weight() const override { return 0.2; }
  void distribute(const std::vector<int> &owner,
                  MPI_Comm communicator) override;

  /** Takes up what the last kick did to the nodes, and moves them rigidly. */
  void impose_velocities(const double time) override;
  void accumulate_work(const double half_dt) override;
  void update_ghosts() override {}
  /** Moves the body by @p dt and clears the forces. */
  void compute_forces(const double time, const double dt) override;
  /** A twentieth of a radian of rotation, for the midpoint rule; contact bounds
      the step by its own. */
  StableStep stable_step() const override;
  bool update_topology(const unsigned int, const double) override
  {
    return false;
  }

  void add_energies(EnergyLedger &ledger) const override;
  BodyMeasures measure() const override;
  BodyFacts facts() const override;
  bool is_held() const override { return options.is_prescribed; }
  OutputMesh output_mesh() const override;
  void visit_state(StateVisitor &visitor) override;
  ContactSurface contact_surface() const override;
  const FaceView *faces() const override { return this; }
  std::vector<std::array<std::size_t, 8>> cells_behind_faces() const override
  {
    return {};
  }
  bool deform() const override { return false; }
  bool moves_node_by_node() const override { return false; }

  std::string item_name() const override { return "cells"; }
  GlobalIndex n_items() const override { return n_global_cells; }
  std::string step_timer_name() const override { return "rigid step"; }

  // For verification problems.
  double total_mass() const { return mass; }
  /** About the center, in the initial frame [kg m^2]. */
  const Mat &inertia_tensor() const { return inertia; }

private:
  /** omega = Q I^-1 Q^T l for the rotation Q [1/s]. */
  Vec spin(const Mat &rotation) const;
  /** Faces whose nodes are all here, and the mean edge of all faces. */
  void take_faces(const LocalPart &part);
  /** Rigid motion of the owned nodes, v = p/m + omega x r. */
  void set_velocities();
  /** Rotation by a unit quaternion (w, x, y, z). */
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
  double typical_spacing = 0.;

  double mass = 0.;                // [kg]
  Mat inertia, inverse_inertia;    // initial frame
  AlignedVector<Vec> arm;          // of all local nodes, initial frame [m]
  std::vector<double> node_masses; // of all nodes, until distribute()
  // The same on every rank
  Vec center, momentum, angular_momentum;
  std::array<double, 4> quaternion{{1., 0., 0., 0.}};
  AlignedVector<Vec> rigid_velocity; // of owned nodes, before the kick
  ExactSum work;
};
} // namespace sabot

#endif
