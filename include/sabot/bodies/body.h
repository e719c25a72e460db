#ifndef sabot_bodies_body_h
#define sabot_bodies_body_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body_facts.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/outline.h"

#include <mpi.h>

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace sabot
{
class MassScaling;
class VelocityConstraints;
class CellSource;
class ParticleSink;

/** A proposal for the stable step and who makes it. The default proposes
    nothing: the largest double. item is a global number, for the log and for
    messages of a step that has become too short. */
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
    with outward normal by the right-hand rule. Made anew when asked for:
    couplings keep it until contact_surface_version() changes. */
struct ContactSurface
{
  std::vector<std::array<std::size_t, 4>> faces; // any local node index
  std::vector<GlobalIndex> face_id;              // same on every rank
  std::vector<std::size_t> nodes;                // owned, may touch faces
  /** Parallel to nodes: the part of a node that a model cut at symmetry planes
      holds, 1/2 on a plane, 1/4 on two; empty where all are whole. */
  std::vector<double> node_share;
  std::vector<SymmetryPlane> symmetry_planes; // the same on every rank
  /** Parallel to nodes: edge_distances() [m]; empty where they change or are
      not known. */
  std::vector<double> edge_distance;
  double bulk_modulus = 0.; // [Pa], for the penalty
  double spacing = 0.;      // [m], typical node distance
  /** [m] between particles along the surface, at the start; at most. */
  double largest_spacing = 0.;
};

/** Faces that bear a load, on this rank; of bodies of cells faces, of particles
    their shares in the areas. Planes of symmetry are none. */
struct LoadedSurface
{
  /** Local nodes, all around every owned node, outward normal by the right-hand
      rule, ascending by their numbers in the body. */
  std::vector<std::array<std::size_t, 4>> faces;
  struct Share
  {
    std::size_t node; // owned
    Vec area;         // outward, at the start [m^2]
  };
  std::vector<Share> shares; // ascending by node
};

/** A node of a body without faces, as part of its surface. */
struct SurfacePoint
{
  Vec normal = {};     // unit, outward; zero where the node is not on it
  double spacing = 0.; // [m], of such nodes, along the deformed surface
  /** How far the normal is to be trusted beside another one: 1 on smooth
      parts, little on edges and corners. */
  double flatness = 0.;
  /** 2 (1 - cosine) with the least cosine to the normal of the faces around, at
      the start: the largest of the squares of their angles to it. */
  double spread = 0.;
};

/**
 * A node of a body without faces as part of its volume: it fills the share
 * content phi(|to_unit (x - x_j)|) of the space at x, phi the cubic spline. The
 * shares of all nodes add to 1 deep inside the body, to 1/2 on its surface.
 *
 * content has no unit: with the ellipsoid's volume it gives the matter of the
 * node.
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
  /** Of each of them, whether it is part of crumbled metal that its body keeps
      a continuum: such pairs bear pressure already, and no bond between two of
      them holds by itself. Empty: none is. */
  std::vector<char> is_continuous;
  double bulk_modulus = 0.; // [Pa]
  double spacing = 0.;      // [m]
};

/** A connected piece of a body whose bonds may fail. By Body::fragments(); a
    particle without bonds is a fragment of its own. A piece that a plane of
    symmetry cuts is the whole piece, of which the model holds a part. */
struct Fragment
{
  GlobalIndex label = -1;           // least number of a particle in it
  GlobalIndex n_particles = 0;      // of the model
  double mass = 0.;                 // of the whole piece [kg]
  std::array<double, 3> velocity{}; // of its center of mass [m/s]
  int copies = 1; // it and its mirror images in planes that do not cut it
};

/** Damage and flow at one place of a body's material. For the verdict on
    zones of particles: how far flow and failure came by the end of a run. In
    the undeformed configuration. */
struct MaterialSite
{
  std::array<double, 3> reference_position; // particle or center of cell [m]
  double plastic_strain = 0.;               // effective
  double failed_share = 0.;                 // of the bonds that end here
};

/** View of a body whose surface is faces with cells behind them. Local to a
    rank. The parallel arrays are those of contact_surface(). */
class FaceView
{
public:
  virtual ~FaceView() = default;
  /** Nodes (local, VTK order) of the cells behind the faces of
      contact_surface(), where this rank owns the face's lowest node. Ties
      take the trilinear functions of such a cell for nodes that stand off
      its face. */
  virtual std::vector<std::array<std::size_t, 8>>
  cells_behind_faces() const = 0;
  /** Add this rank's share of the force [N] on the part of the body that lies
      beyond a plane of the reference configuration, X . @p normal > @p offset
      [m], by the rest of it: the internal forces of its nodes. Of the cells
     that the plane cuts; inside of others they add up to nothing. */
  virtual void add_section_force(const Vec /*normal*/, const double /*offset*/,
                                 ExactVectorSum & /*sum*/) const
  {
  }
  /** Whether the faces deform: only such a body leads a tie or folds onto
      itself. */
  virtual bool deform() const = 0;
};

/** View of a body whose faces may bear loads, or that may be moved from
   outside. All functions are local to a rank. */
class LoadView
{
public:
  virtual ~LoadView() = default;
  /** These faces, by their boundary ids, will be asked for by
      loaded_surface(). Before distribute(). */
  virtual void keep_faces(const std::vector<unsigned int> & /*ids*/) {}
  /** The faces with these boundary ids that are left, on this rank; those that
      erosion opens are none of them. Changes with contact_surface_version(). */
  virtual LoadedSurface
  loaded_surface(const std::vector<unsigned int> &ids) const = 0;
  /** From now on its motion is the one of move_rigidly(); false for a body that
      deforms. Before distribute(). */
  virtual bool prescribe_rigid_motion() { return false; }
  /** Velocity of the center of mass [m/s] and rotation per time [1/s] from now
      on. @p is_start: the change is no impulse. */
  virtual void move_rigidly(const Vec /*velocity*/,
                            const Vec /*angular_velocity*/,
                            const bool /*is_start*/)
  {
  }
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
  /** What has become of an @p area [m^2] of the start at owned node @p i, by
      its deformation gradient: det F F^-T A (Nanson). Zero for what lost a
      direction and has no shape any more. */
  virtual Vec present_area(const std::size_t i, const Vec area) const = 0;
  /** The body's own part of the force on owned node @p i [N], now. */
  virtual Vec own_force(const std::size_t i) const = 0;
  /** What has come loose; empty for a body whose parts never do. */
  virtual DebrisView debris() const = 0;
  /** Whether owned node @p i is still bonded to node @p j (global). */
  virtual bool are_bonded(const std::size_t i, const GlobalIndex j) const = 0;
  /** The same of an image of @p j beyond planes of symmetry, which is at
      @p place now [m]. */
  virtual bool are_bonded(const std::size_t i, const GlobalIndex j,
                          const Vec place) const = 0;
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
  /** The label of the piece that each owned node belongs to. Collective. */
  virtual std::vector<GlobalIndex> piece_labels() const = 0;
};

/**
 * Anything with nodes that moves. The integrator, the couplings and the output
 * see bodies through this class only.
 *
 * A body is made in two phases: its constructor lays out all nodes, the same
 * on every rank (partition_points()); distribute() then keeps what this rank
 * owns.
 *
 * SI units, one fixed frame. Node arrays hold owned nodes first, then ghosts,
 * both by ascending global number. "Collective" means that all ranks of the
 * communicator call it together; everything else is local.
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
  /** Keep the nodes whose owner is this rank; all ranks call it. Positions
      at the start and all reference data are made here, and data of the
      whole body are released. Collective. */
  virtual void distribute(const std::vector<int> &owner,
                          MPI_Comm communicator) = 0;

  /** Owner rank of every node in global order, the same on every rank; set by
      whoever calls distribute(). */
  std::vector<int> node_owner;

  /** Boundary ids of the faces that the entry @p path names in @p text;
      InputError for names that the body does not have. Set by whoever made the
      body from a shape. */
  std::function<std::vector<unsigned int>(const std::string &path,
                                          const std::string &text)>
      find_faces;

  NodalState &nodes() { return nodal_state; }
  const NodalState &nodes() const { return nodal_state; }

  /** Velocities that are prescribed, e.g. of clamped nodes. After every
      kick; a rigid body also collects the impulses of its nodes here, which
      makes it collective. */
  virtual void impose_velocities(const double time) = 0;
  /** Work of the current forces on prescribed velocities along half a step's
      motion (called before and after each drift). */
  virtual void accumulate_work(const double /*half_dt*/) {}
  /** Copy positions and velocities that the forces need to other ranks.
      After every drift, before compute_forces(). Collective. */
  virtual void update_ghosts() = 0;
  /** Set force of every owned node to external - internal - stabilization.
      @p dt is the step that led to the current positions, no_step at the start.
      Collective. */
  virtual void compute_forces(const double time, const double dt) = 0;
  /** Largest stable step seen from this rank, in the current state. [s],
      without the scene's step factor; item is a global number. Local: the
      integrator takes the least of all. */
  virtual StableStep stable_step() const = 0;
  /** What is done between steps: kernel updates, bond failure, erosion. Where
      this changes the body's part of the forces, the array of forces already
      holds the new part on return. Collective.
      @return whether it may have, the same on all ranks. */
  virtual bool update_topology(const unsigned int step, const double time) = 0;
  /** Add inertia where items ask for less than the body's smallest step, after
      the first forces and then after update_topology(); @p dt [s] is the step
      just made, 0 at the start. Collective.
      @return whether any was, the same on all ranks. Throws PhysicsError, on
      all ranks, where it is more than the body may get. */
  virtual bool hold_step(const unsigned int /*step*/, const double /*dt*/)
  {
    return false;
  }

  /** Kinetic energy of the last half kick by itself, sum of m |dt f/(2 m)|^2/2
      over owned nodes that it moves [J]. What stands in the ledger is v at
      whole steps, and works along v at half steps: their difference is this
      energy, which comes and goes with the forces. Of a rigid body by its six
      degrees of freedom. Collective; each adds its share. */
  virtual void add_kick_energy(const double dt, ExactSum &sum) const;
  /** Add this rank's share. [J], owned nodes and items only, so that the sum
      over ranks counts each once. Local. */
  virtual void add_energies(EnergyLedger &ledger) const = 0;
  /** The whole body at this moment. Collective, same on all ranks. */
  virtual BodyMeasures measure() const = 0;
  /** This rank's part, at present positions [m], with the fields @p wanted, or
      all; names and units of fields are described ones. Collective. */
  OutputMesh output_mesh(const std::vector<std::string> &wanted = {}) const
  {
    OutputMesh mesh;
    mesh.point_fields.wanted = mesh.cell_fields.wanted = wanted;
    fill_output(mesh);
    return mesh;
  }
  /** Everything that a restart needs. The same order for writing and
      reading; collective where bonds or ghosts have to be found again. */
  virtual void visit_state(StateVisitor &visitor) = 0;

  /** This rank's part of what may be touched, now. */
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

  /** Pieces of this body that slide on each other do so with this coefficient
      of friction, as self-contact has it. Before distribute(). */
  virtual void set_internal_friction(const double /*coefficient*/) {}

  // What only some bodies are: null for the others.
  virtual const FaceView *faces() const { return nullptr; }
  virtual const ParticleView *particles() const { return nullptr; }
  virtual const FragmentView *fragments() const { return nullptr; }
  virtual LoadView *loadable() { return nullptr; }
  virtual CellSource *cell_source() { return nullptr; }
  virtual ParticleSink *particle_sink() { return nullptr; }
  virtual const MassScaling *mass_scaling() const { return nullptr; }
  /** Whether nodes move by their own forces, so that a tie may lead them; not
      those of a rigid body. */
  virtual bool moves_node_by_node() const { return true; }

  /** What is known of it before the run; before distribute() where it is asked
      for its mesh. */
  virtual BodyFacts facts() const = 0;
  /** What moves it as a whole from outside, "prescribed motion"; what its
      prescribed() velocities hold is not in it. Collective. */
  virtual std::vector<Resultant> reactions() const { return {}; }
  /** Whether something outside of the scene acts on it, e.g. a clamp, so that
      momentum is not kept. */
  virtual bool is_held() const = 0;
  /** Which velocities of owned nodes are prescribed, after distribute(); null:
      none ever is. */
  const VelocityConstraints *prescribed() const
  {
    return prescribed_velocities;
  }
  /** Where the model of the body is cut, the same on every rank. */
  virtual std::vector<SymmetryPlane> planes_of_symmetry() const { return {}; }

  /** This rank's cells or particles as places of flow and failure. */
  virtual std::vector<MaterialSite> material_sites() const { return {}; }

  /** "particles" or "cells", the number over all ranks, and the name of the
      timer of the force loop ("spg step", "fem step"). */
  virtual std::string item_name() const = 0;
  virtual GlobalIndex n_items() const = 0;
  virtual std::string step_timer_name() const = 0;

  /** The body of the particles that its cells turn into; null: none. Set by
      whoever made the two. */
  const Body *own_particles = nullptr;

  /** Its true shape at the start, from the constructor on; whoever checks the
      scene takes it away. Without faces where there are none to show. */
  Outline outline;

protected:
  /** The mesh and those fields that its lists want. Collective. */
  virtual void fill_output(OutputMesh &mesh) const = 0;

  NodalState nodal_state;
  /** Of a body whose nodes move by their own forces: which of their components
      do not. */
  const VelocityConstraints *prescribed_velocities = nullptr;
};
/** Mass, velocity, kinetic energy, bounds and what has eroded of a body
   together with the particles that its cells turned into. Collective. */
BodyMeasures measure_with_particles(const Body &body);

/** The nodes here, as arrays of a state belong to them; images are made anew.
 */
inline StateItems nodes_of_state(const Body &body)
{
  const NodalState &nodes = body.nodes();
  return {"body " + body.name + "/nodes", nodes.global_id.data(), nodes.n_owned,
          nodes.size() - nodes.n_images};
}
} // namespace sabot

#endif
