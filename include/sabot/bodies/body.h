#ifndef sabot_bodies_body_h
#define sabot_bodies_body_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body_facts.h"

#include <mpi.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace sabot
{
/** A proposal for the stable step and who makes it. */
struct StableStep
{
  double dt = std::numeric_limits<double>::max(); // [s]
  GlobalIndex item = -1;                          // node, particle or cell
};

/** Flow stress of what never yields [Pa]: beyond all stresses, but finite, so
    that means over nodes with weights of zero stay defined. */
constexpr double never_yields = 1e300;

/** A plane across an axis on which a model is cut. */
struct SymmetryPlane
{
  int axis;
  double coordinate; // [m]
  bool operator==(const SymmetryPlane &o) const
  {
    return axis == o.axis && coordinate == o.coordinate;
  }
};

/** What other bodies may touch; indices are local. Faces are quadrilaterals
    with outward normal by the right-hand rule. */
struct ContactSurface
{
  std::vector<std::array<std::size_t, 4>> faces; // any local node index
  std::vector<GlobalIndex> face_id;              // same on every rank
  std::vector<std::size_t> nodes;                // owned, may touch faces
  /** Parallel to nodes: the part of a node that a model cut at symmetry planes
      holds, 1/2 on a plane, 1/4 on two; empty where all are whole. */
  std::vector<double> node_share;
  std::vector<SymmetryPlane> symmetry_planes; // the same on every rank
  double bulk_modulus = 0.;                   // [Pa], for the penalty
  double spacing = 0.;                        // [m], typical node distance
};

/** A node of a body without faces, as part of its surface. */
struct SurfacePoint
{
  Vec normal = {};     // unit, outward; zero where the node is not on it
  double spacing = 0.; // [m], of such nodes, along the deformed surface
  /** How far the normal is to be trusted beside another one: 1 on smooth
      parts, little on edges and corners. */
  double flatness = 0.;
};

/**
 * A node of a body without faces as part of its volume: it fills the share
 * content phi(|to_unit (x - x_j)|) of the space at x, phi the cubic spline. The
 * shares of all nodes add to 1 deep inside the body, to 1/2 on its surface.
 */
struct VolumePoint
{
  Mat to_unit = Mat::zero(); // [1/m], of the node's ellipsoid to the unit ball
  double content = 0.;
};

/** Owned nodes that have come loose (a failed bond), which may meet each other
    again, and how stiff they are. */
struct DebrisView
{
  std::vector<std::size_t> nodes; // owned, ascending
  double bulk_modulus = 0.;       // [Pa]
  double spacing = 0.;            // [m]
};

/** A connected piece of a body whose bonds may fail. */
struct Fragment
{
  GlobalIndex n_particles = 0;
  double mass = 0.;                 // [kg]
  std::array<double, 3> velocity{}; // of the center of mass [m/s]
};

/** Damage and flow at one place of a body's material. */
struct MaterialSite
{
  std::array<double, 3> reference_position; // particle or center of cell [m]
  double plastic_strain = 0.;               // effective
  double failed_share = 0.;                 // of the bonds that end here
};

/** View of a body whose surface is faces with cells behind them. */
class FaceView
{
public:
  virtual ~FaceView() = default;
  /** Nodes (local, VTK order) of the cells behind the faces of
      contact_surface(), where this rank owns the face's lowest node. */
  virtual std::vector<std::array<std::size_t, 8>>
  cells_behind_faces() const = 0;
  /** Whether the faces deform: only such a body leads a tie or folds onto
      itself. */
  virtual bool deform() const = 0;
};

/** View of a body of particles, which has a surface without faces and whose
    parts may come loose. All functions are local to a rank. */
class ParticleView
{
public:
  virtual ~ParticleView() = default;
  /** Owned node @p i as part of a surface without faces, now. */
  virtual SurfacePoint surface_point(const std::size_t i) const = 0;
  /** Owned node @p i as part of a volume without cells, now. */
  virtual VolumePoint volume_point(const std::size_t i) const = 0;
  /** What has come loose; empty for a body whose parts never do. */
  virtual DebrisView debris() const = 0;
  /** Whether owned node @p i is still bonded to node @p j (global). */
  virtual bool are_bonded(const std::size_t i, const GlobalIndex j) const = 0;
  /** Bonds of owned particles, each counted at both ends. */
  virtual std::size_t n_bonds() const = 0;
};

/** View of a body that may come apart. */
class FragmentView
{
public:
  virtual ~FragmentView() = default;
  /** Pieces that bonds still hold together, heaviest first. Collective, same
      on all ranks. */
  virtual std::vector<Fragment> connected_pieces() const = 0;
};

/**
 * Anything with nodes that moves. The integrator, the couplings and the output
 * see bodies through this class only.
 *
 * A body is made in two phases: its constructor lays out all nodes, the same
 * on every rank (partition_points()); distribute() then keeps what this rank
 * owns.
 */
class Body
{
public:
  Body(const std::string &name, const int id) : name(name), id(id) {}
  virtual ~Body() = default;

  const std::string name;
  const int id;

  /** Positions of all nodes in global order, before distribute(). */
  virtual const std::vector<std::array<double, 3>> &
  partition_points() const = 0;
  /** Cost of one node, relative to others, for the partition. */
  virtual double partition_weight() const = 0;
  /** Keep the nodes whose owner is this rank; all ranks call it. */
  virtual void distribute(const std::vector<int> &owner,
                          MPI_Comm communicator) = 0;

  /** Owner rank of every node in global order, the same on every rank; set by
      whoever calls distribute(). */
  std::vector<int> node_owner;

  NodalState &nodes() { return nodal_state; }
  const NodalState &nodes() const { return nodal_state; }

  /** Velocities that are prescribed, e.g. of clamped nodes. */
  virtual void impose_velocities(const double time) = 0;
  /** Work of the current forces on prescribed velocities along half a step's
      motion (called before and after each drift). */
  virtual void accumulate_work(const double /*half_dt*/) {}
  /** Copy positions and velocities that the forces need to other ranks. */
  virtual void update_ghosts() = 0;
  /** Set force of every owned node to external - internal - stabilization.
      @p dt is the step that led to the current positions (0 at the start).
      Collective. */
  virtual void compute_forces(const double time, const double dt) = 0;
  /** Largest stable step seen from this rank, in the current state. */
  virtual StableStep stable_step() const = 0;
  /** What is done between steps: kernel updates, bond failure, erosion. Where
      this changes the body's part of the forces, the array of forces already
      holds the new part on return. Collective.
      @return whether it may have, the same on all ranks. */
  virtual bool update_topology(const unsigned int step, const double time) = 0;

  /** Add this rank's share. */
  virtual void add_energies(EnergyLedger &ledger) const = 0;
  /** The whole body at this moment. Collective, same on all ranks. */
  virtual BodyMeasures measure() const = 0;
  virtual OutputMesh output_mesh() const = 0;
  /** Everything that a restart needs. */
  virtual void visit_state(StateVisitor &visitor) = 0;

  virtual ContactSurface contact_surface() const = 0;
  /** Changes whenever contact_surface() would return something new. */
  virtual unsigned int contact_surface_version() const { return 0; }

  /** Present uniaxial flow stress [Pa] of the surface at some owned nodes of
      it; never_yields where that is so. */
  virtual std::vector<double>
  flow_stress(const std::vector<std::size_t> &some_nodes) const
  {
    return std::vector<double>(some_nodes.size(), never_yields);
  }

  // What only some bodies are: null for the others.
  virtual const FaceView *faces() const { return nullptr; }
  virtual const ParticleView *particles() const { return nullptr; }
  virtual const FragmentView *fragments() const { return nullptr; }
  /** Whether nodes move by their own forces, so that a tie may lead them; not
      those of a rigid body. */
  virtual bool moves_node_by_node() const { return true; }

  /** What is known of it before the run; before distribute() where it is asked
      for its mesh. */
  virtual BodyFacts facts() const = 0;
  /** Whether something outside of the scene acts on it, e.g. a clamp, so that
      momentum is not kept. */
  virtual bool is_held() const = 0;
  /** Where the model of the body is cut, the same on every rank. */
  virtual std::vector<SymmetryPlane> planes_of_symmetry() const { return {}; }

  /** This rank's cells or particles as places of flow and failure. */
  virtual std::vector<MaterialSite> material_sites() const { return {}; }

  /** "particles" or "cells", the number over all ranks, and the name of the
      timer of the force loop ("spg step", "fem step"). */
  virtual std::string item_name() const = 0;
  virtual GlobalIndex n_items() const = 0;
  virtual std::string step_timer_name() const = 0;

protected:
  NodalState nodal_state;
};
} // namespace sabot

#endif
