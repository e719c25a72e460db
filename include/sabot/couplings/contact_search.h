#ifndef sabot_couplings_contact_search_h
#define sabot_couplings_contact_search_h

#include "sabot/couplings/contact_spring.h"
#include "sabot/couplings/node_halo.h"
#include "sabot/couplings/surface_normals.h"
#include "sabot/kernels/closest_point.h"

namespace sabot
{
/** Nodes of one body against the faces of another, by numbers of bodies. With
    itself: a body that folds, whose nodes meet the faces that they look at from
    outside (within 75 degrees) and that share no node with their own faces. */
struct ContactPair
{
  int faces_of, nodes_of;
  bool loose_nodes_only = false; // of a tied pair: only debris meets
};

/** A face with the places of its corners, as ranks tell each other. */
struct FaceNodes
{
  std::int32_t body;
  GlobalIndex id; // ContactSurface::face_id
  std::array<GlobalIndex, 4> node;
  std::array<Vec, 4> x; // [m], current
};

/** A node and the faces of one body that it may touch until the bodies have
    moved by the skin. */
struct ContactCandidate
{
  NodeKey node;
  double share;                       // ContactSurface::node_share
  std::int64_t first_face, last_face; // of SearchResult::face_of_candidate
  ContactMemory memory;
  Vec area; // quarters of the vectors of its own faces, where asked for [m^2]
  SmoothNormal own; // of a particle on a sound surface
  /** Of a node on a plane of symmetry of the faces' body that its own body,
      which reaches beyond, does not have: 1/2, for the other half presses on
      the image; a quarter on two. */
  double cut;
};

/** What a search found: of nodes owned here, and of others that may touch a
   face with a corner owned here. A node that may touch several bodies has one
    candidate for each, one after the other. Among the faces are all around the
    corners of those that a node may touch, and around the nodes of candidates.
 */
struct SearchResult
{
  std::vector<FaceNodes> faces;                // sorted by body and id
  std::vector<std::int64_t> face_of_candidate; // indices of faces
  std::vector<ContactCandidate> candidates;    // sorted by node, then body
  /** Boxes of faces that this rank compared nodes with: what it cost, whatever
      else the machine does. */
  std::int64_t n_compared = 0;
};

/** Memories of the nodes owned here, sorted by node: a node that went deeper
    than a spacing still sees the face that it came by. */
using ContactMemories = std::vector<std::pair<NodeKey, ContactMemory>>;

/**
 * Bucket search: every node of the pairs with the faces whose boxes along the
 * axes are closer than
 * max(spacing, its depth, at most 3 spacings) + skin. Three steps: faces near
 * the other body's nodes go to the ranks with nodes near them and into buckets;
 * each rank tries its own nodes; what was found goes to the ranks that own a
 * part of it (share_candidates()). Cost is linear in nodes and faces near the
 * overlap of the bodies' bounding boxes.
 */
struct ContactSearch
{
  const std::vector<Body *> &bodies;
  /** Of all bodies, as they are now; those of no pair may be empty. */
  const std::vector<ContactSurface> &surfaces;
  const std::vector<ContactPair> &pairs;
  const ContactMemories &memories;
  double spacing, skin; // [m]
  bool with_areas;      // whether ContactCandidate::area is asked for
  MPI_Comm communicator;

  /** Collective. */
  SearchResult find() const;
};
} // namespace sabot

#endif
