#ifndef sabot_couplings_share_candidates_h
#define sabot_couplings_share_candidates_h

#include "sabot/couplings/contact_search.h"

namespace sabot
{
/**
 * Each rank found what its own nodes may touch, @p result: candidates, and
 * faces with all those around their corners and the nodes, in order. Adds what
 * other ranks found and this one computes as well: candidates of nodes that may
 * touch a face with a corner owned here, or have one themselves, with those
 * faces and the faces around them. Then candidates and faces are in order
 * again. Collective; what goes from rank to rank grows with what meets at their
 * border.
 */
void share_candidates(SearchResult &result, const std::vector<Body *> &bodies,
                      MPI_Comm communicator);
} // namespace sabot

#endif
