#ifndef sabot_bodies_spg_failure_fragments_h
#define sabot_bodies_spg_failure_fragments_h

#include "sabot/base/types.h"
#include "sabot/bodies/body.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
class BondList;
class GhostExchange;

/** Label of the connected piece that each owned particle belongs to: the least
    global number in it, the same on every number of ranks. Collective. */
std::vector<GlobalIndex> fragment_labels(const NodalState &nodes,
                                         const BondList &bonds,
                                         const GhostExchange &exchange,
                                         MPI_Comm communicator);

/** The pieces themselves, heaviest first; masses [kg] and momenta are exact
    sums, so they do not depend on the number of ranks. Collective, the same on
    all ranks. */
std::vector<Fragment> find_fragments(const NodalState &nodes,
                                     const std::vector<GlobalIndex> &label,
                                     MPI_Comm communicator);
} // namespace sabot

#endif
