#ifndef sabot_couplings_contact_h
#define sabot_couplings_contact_h

#include "sabot/couplings/closing_speed.h"
#include "sabot/couplings/contact_options.h"
#include "sabot/couplings/contact_patch.h"
#include "sabot/couplings/contact_points.h"
#include "sabot/couplings/contact_search.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/face_standing.h"
#include "sabot/couplings/halo_forces.h"
#include "sabot/couplings/shared_work.h"

namespace sabot
{
/**
 * Node-to-face penalty contact with friction between several bodies: nodes of
 * each body (all particles, surface nodes of hexahedra) against the boundary
 * faces of every other. A tied pair meets only through nodes that have come
 * loose. The parts, each in its own room:
 *
 * - ContactSearch: which faces a node may touch until the bodies moved on;
 * - FaceStanding: which of them holds it, with what gap and normal;
 * - ContactPatch: which nodes take a particle's force on fine faces;
 * - ContactPoints: spring and friction on all nodes that press.
 *
 * The force on a node with gap g < 0 is n max(0, -k g - c dg/dt), as
 * SpringOptions say, with the reduced mass of node and face so that neither
 * penalty nor friction can overshoot. Whoever owns a node computes all that
 * acts on it, from the same numbers in the same order, so that results do not
 * depend on the number of ranks.
 */
class Contact : public Coupling
{
public:
  /** @p bodies: all of the scene, by number; @p pairs: who meets whose faces,
      each direction for itself, a body with itself for one that folds. */
  Contact(const std::string &name, const std::vector<Body *> &bodies,
          const std::vector<ContactPair> &pairs, const ContactOptions &options,
          MPI_Comm communicator);

  std::string kind() const override { return "contact"; }
  /** Of pairs (faces, nodes), both directions where both are listed. */
  std::vector<std::pair<int, int>> holds_apart() const override;
  double stability_fraction() const override
  {
    return options.stability_fraction;
  }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void keep_stiffness(const double) override { points.steady_step.keep(); }
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  std::size_t n_items() const override { return groups.size(); }
  Measures measure() const override;
  std::vector<Resultant> resultants() const override
  {
    return forces.resultants(name, holds_apart(), halo, communicator);
  }
  void visit_state(StateVisitor &visitor) override;

  /** Largest penetration at the start over the nodal spacing, the same on all
      ranks, and the node where this rank found its own largest. */
  double initial_penetration() const { return initial_over_spacing; }
  const NodeKey &initial_penetration_node() const { return initial_node; }

private:
  /** A node and the faces it may touch, with what the law needs of them. A node
      that meets several bodies has one group with the faces of all: it is held
      by one face at a time. */
  struct Group : NearFaces
  {
    double stiffness; // s K h [N/m]
    double area;      // over which friction may act [m^2]
    Vec area_vector;  // of the node's own faces, zero where it has none
    ContactMemory memory;
    /** Distance the bodies may travel before the node can touch a face. */
    double wake = 0.;
    /** ContactPatch::radius() [m]; 0: it presses at a point. */
    double patch_radius = 0.;
    double share = 1.; // ContactSurface::node_share
    double cut = 1.;   // ContactCandidate::cut
  };
  /** A group as a checkpoint holds it, by global numbers; its faces stand
     apart. Written bit by bit. */
  struct SavedGroup
  {
    NodeKey node;
    std::int64_t n_faces;
    double stiffness, spacing, area;
    Vec area_vector;
    SmoothNormal own;
    ContactMemory memory;
    double wake, patch_radius, share, cut;
  };
  struct SavedFace
  {
    NodeKey key; // body and number of the face
    std::array<GlobalIndex, 4> node;
  };
  struct SavedGroups
  {
    std::vector<SavedGroup> groups;      // of nodes owned here
    std::vector<NodeKey> faces_of_nodes; // of the groups, keys of faces
    std::vector<SavedFace> faces;        // several ranks may have one
  };
  NodeKey key_of_face(const std::size_t f) const
  {
    return {halo.key(faces.corners[f][0]).body, 0, face_ids[f]};
  }
  SavedGroups save_groups() const;
  /** Halo, groups and faces as they were, of what all ranks saved: candidates
      cannot be found anew, for the bodies moved since the last search.
      Collective. */
  void restore_groups(SavedGroups &saved);
  Group restored_group(const SavedGroup &from, const SearchResult &found,
                       const std::vector<std::size_t> &number_of_face);
  /** Ask the bodies of all pairs for their surfaces, which erosion changes. */
  void update_surfaces();
  /** ContactPatch::radius() between two bodies [m]. */
  double patch_radius(const int nodes_of, const int faces_of) const;

  // Search: due when the bodies may together have covered the skin.
  /** New groups, which inherit the memories of nodes that are still candidates.
      Collective. */
  void search();
  /** The candidates first to last - 1 of one node. */
  struct KeptNode
  {
    std::size_t first, last;
  };
  /** What touches nodes owned here, with its halo. @param[out] number_of_face:
      number among the faces kept, of all that were found. */
  std::vector<KeptNode> keep_relevant(const SearchResult &found,
                                      std::vector<std::size_t> &number_of_face);
  /** Adds its faces to the list, too. */
  Group make_group(const SearchResult &found, const KeptNode &node,
                   const std::vector<std::size_t> &number_of_face);
  /** Arrays per slot, for the present halo. Collective. */
  void reset_slots();
  /** Per slot what @p of_surface [ContactSurface::nodes] says of its node,
      @p otherwise where that is empty. Collective. */
  std::vector<double>
  gather_of_slots(std::vector<double> ContactSurface::*const of_surface,
                  const double otherwise) const;

  // Forces
  /** Where everything starts: bodies may touch already. */
  void settle();
  /** Adds a contact point where a face holds the node. */
  void press(const std::size_t number, const double dt);
  /** Append the nodes that take the node's force: those of the patch, or the
      four of the face. Sets @p normal and @p depth. */
  void touch(const Group &group, const std::ptrdiff_t face,
             const FaceProjection &projection, Vec &normal, double &depth);
  /** Of the node against what it touches from number @p first on [kg]: the
      part that the model holds of the reduced mass that both have in the whole,
      1/m = 1/m_node + sum w^2/m_touched, so that a model cut at planes of
      symmetry has the same springs. */
  double reduced_mass(const Group &group, const std::size_t first) const;
  /** Append to what is touched the corners of the node's own face that share
      what it presses with, so that all together it is the place's. */
  void press_between_nodes(const Group &group, const PressingPlace &place);
  /** Of the place with which the node presses, and that against what it
      touches [m/s]. */
  Vec velocity_of_place(const AlignedVector<Vec> &velocity, const Group &group,
                        const ContactPoint &point) const;
  Vec velocity_against(const AlignedVector<Vec> &velocity, const Group &group,
                       const ContactPoint &point) const;
  /** With which what presses may have come in [m/s]. */
  double largest_speed(const Group &group, const ContactPoint &point) const;
  /** Of friction per area [Pa], between a node and what it touches. */
  double shear_limit(const Group &group, const std::size_t first) const;
  /** Forces on the node, and their opposite, in parts, on what it touches: the
      sum over slots is zero, so linear momentum is exact. */
  void push(const ContactPoint &point);

  const std::vector<Body *> bodies;
  const std::vector<ContactPair> pairs;
  const ContactOptions options;
  MPI_Comm communicator;
  NodeHalo halo;
  FaceStanding faces;
  ContactPatch patch;
  std::vector<GlobalIndex> face_ids; // of the faces, ContactSurface::face_id
  std::vector<Group> groups;
  std::vector<ContactSurface> surfaces; // of the pairs' bodies
  HaloForces forces;
  std::vector<double> flow_stress; // per slot, at the last search; may be empty
  std::vector<double> share;       // per slot, ContactSurface::node_share
  ContactPoints points;            // of the step
  SharedWork shared_work;
  std::vector<TouchedNode> touched; // by the points, one after the other
  unsigned int surface_version = 0; // sum over bodies at the last search
  double skin = 0., traveled = 0.;  // [m]
  ClosingSpeed closing_speed;
  double initial_over_spacing = 0., penetration_over_spacing = 0.;
  NodeKey initial_node{-1, 0, -1};
};
} // namespace sabot

#endif
