#ifndef sabot_couplings_contact_search_h
#define sabot_couplings_contact_search_h

#include "sabot/couplings/node_halo.h"
#include "sabot/kernels/closest_point.h"

namespace sabot
{
/** Nodes of one body against the faces of another (indices of bodies). */
struct ContactPair
{
  int faces_of, nodes_of;
  bool loose_nodes_only = false;
};

/**
 * What is known of a node's past contact. A node that is found inside without
 * having come in through a face (at the start, or because the closest face
 * changed) repels only below the depth at which it was found: no energy enters.
 */
struct ContactMemory
{
  double depth = -1.; // at the last step [m]; negative: not known
  double offset = 0.; // part of the depth that does not repel [m]
};

/** A node that may touch faces until the bodies have moved by the skin. */
struct ContactCandidate
{
  NodeKey node;
  std::int64_t face; // index into SearchResult::faces
  double share;      // ContactSurface::node_share
  ContactMemory memory;
};

struct FaceNodes
{
  std::int32_t body;
  GlobalIndex id;
  std::array<GlobalIndex, 4> node;
  std::array<Vec, 4> x;
};

struct SearchResult
{
  std::vector<FaceNodes> faces;             // the same on every rank
  std::vector<ContactCandidate> candidates; // sorted by node, then face
};

/** Memories of the nodes owned here, sorted by node. */
using ContactMemories = std::vector<std::pair<NodeKey, ContactMemory>>;

/**
 * Bucket search: every node of the pairs with the faces closer than @p reach.
 * The result is the same on every rank; cost is linear in nodes and faces near
 * the overlap of the bodies' bounding boxes. Collective.
 */
SearchResult search_contacts(const std::vector<Body *> &bodies,
                             const std::vector<ContactPair> &pairs,
                             const ContactMemories &memories,
                             const double reach, MPI_Comm communicator);

/** Largest speed among this rank's nodes of the bodies of @p pairs [m/s]. */
double largest_speed(const std::vector<Body *> &bodies, MPI_Comm communicator);
} // namespace sabot

#endif
