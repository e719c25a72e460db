#ifndef sabot_couplings_contact_h
#define sabot_couplings_contact_h

#include "sabot/couplings/contact_law.h"
#include "sabot/couplings/contact_search.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/halo_forces.h"
#include "sabot/couplings/mirror_images.h"

namespace sabot
{
/**
 * Node-to-face penalty contact with Coulomb friction between several bodies:
 * nodes of each body (all particles, surface nodes of hexahedra) against the
 * boundary faces of every other. A node inside is held by the faces that look
 * the way of the one it came through, not by the closest, so that aligned
 * edges cannot slip through each other. A tied pair meets only through nodes
 * that have come loose. The force on a node with gap g < 0 is n max(0, -k g - c
 * dg/dt), k = min(K h, 0.1 m_red/dt^2), with the reduced mass of node and face
 * so that neither penalty nor friction can overshoot.
 */
class Contact : public Coupling
{
public:
  Contact(const std::string &name, const std::vector<Body *> &bodies,
          const std::vector<ContactPair> &pairs, const ContactOptions &options,
          MPI_Comm communicator);

  std::string kind() const override { return "contact"; }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  void visit_state(StateVisitor &visitor) override;

  /** Largest penetration at the start over the nodal spacing, and the node. */
  double initial_penetration() const { return initial_over_spacing; }
  const NodeKey &initial_penetration_node() const { return initial_node; }

private:
  /** A node and the faces it may touch. */
  struct Group
  {
    std::size_t slot;                  // of the halo
    std::size_t first_face, last_face; // of face_of_group
    double stiffness, spacing;
    double area;     // over which friction may act [m^2]
    Vec area_vector; // of the node's own faces, zero where it has none
    ContactMemory memory;
    /** Distance the bodies may travel before the node can touch a face. */
    double wake = 0.;
    /** Radius over which a particle presses [m]; 0: at a point. */
    double patch_radius = 0.;
    double share = 1.; // ContactSurface::node_share
  };
  /** A group as a checkpoint holds it; the nodes of its faces stand apart. */
  struct SavedGroup
  {
    NodeKey node;
    std::int64_t n_faces;
    double stiffness, spacing, area;
    Vec area_vector;
    ContactMemory memory;
    double wake, patch_radius, share;
  };
  void restore_groups(const std::vector<SavedGroup> &saved,
                      const std::vector<NodeKey> &face_nodes);
  void search();
  /** Radius over which a particle presses on the faces of another body; 0 where
      it presses at a point. */
  double patch_radius(const int nodes_of, const int faces_of) const;
  /** Closest of a group's faces, or of those whose normal is within 60 degrees
      of @p side; -1 when none. */
  std::ptrdiff_t closest_face(const Group &group, FaceProjection &projection,
                              const Vec *const side = nullptr) const;
  /** The face that holds a node, if any, as projection with negative gap; the
      memory follows. Motion: the most that the node may have moved against the
      face since the last step. */
  std::ptrdiff_t holding_face(Group &group, FaceProjection &projection,
                              const double dt) const;
  double relative_speed(const Group &group, const std::ptrdiff_t face,
                        const FaceProjection &projection) const;
  /** A node that another presses on, or its mirror image in planes of
      symmetry across the axes of the bits. */
  struct Touched
  {
    std::size_t slot;
    double weight;
    unsigned int mirrored;
  };
  /** What a node presses on: the four nodes of the face that holds it or, of a
      particle, those within its patch, as smooth surface. Sets touched,
      @p normal and @p depth. */
  void spread(const Group &group, const std::ptrdiff_t face,
              const FaceProjection &projection, Vec &normal, double &depth);
  void spread_over_patch(const Group &group, const FaceProjection &projection,
                         Vec &normal, double &depth);
  /** sum w^2/m of what is touched, its mean velocity, and the reaction. */
  double compliance(const Group &group) const;
  Vec velocity_of_touched() const;
  /** Of friction per area [Pa], between a node and what it touches. */
  double shear_limit(const Group &group) const;
  void push_touched(const Vec force, AlignedVector<Vec> &to) const;
  void update_surfaces();

  const std::vector<Body *> bodies;
  const std::vector<ContactPair> pairs;
  const ContactOptions options;
  MPI_Comm communicator;
  NodeHalo halo;
  std::vector<Group> groups;
  std::vector<std::size_t> face_of_group;             // index into face_slots
  std::vector<std::array<std::size_t, 4>> face_slots; // slots of the halo
  std::vector<ContactSurface> surfaces;               // of the pairs' bodies
  std::vector<std::pair<int, int>> body_pairs;
  HaloForces forces;
  std::vector<double> flow_stress; // per slot, at the last search; may be empty
  // Work arrays of spread()
  std::vector<Touched> touched, patch;
  std::vector<Vec> patch_points;
  std::vector<double> patch_areas, patch_weight;
  std::vector<std::ptrdiff_t> touched_number; // per slot; -1
  std::vector<SymmetryPlane> symmetry_planes;
  MirrorImages images;
  unsigned int surface_version = 0; // sum over bodies at the last search
  double skin = 0., travelled = 0.; // [m]
  double initial_over_spacing = 0., penetration_over_spacing = 0.;
  NodeKey initial_node{-1, 0, -1};
};
} // namespace sabot

#endif
