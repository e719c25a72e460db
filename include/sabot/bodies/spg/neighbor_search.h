#ifndef sabot_bodies_spg_neighbor_search_h
#define sabot_bodies_spg_neighbor_search_h

#include "sabot/bodies/spg/bond_list.h"

#include <mpi.h>

namespace sabot
{
class BondFailure;
struct NodalState;
struct ParticleFields;
struct SpgOptions;

/**
 * Rows of neighbors that the kernels of now reach, by the body's policy
 * (SpgOptions::NeighborPolicy): all pairs of which one lies in the kernel of
 * the other, but those whose bond failed; or the present bonds and those pairs
 * of particles without a failed bond. Every rank gets every particle: new
 * neighbors may come from anywhere. Collective.
 */
BondList::Rows search_neighbors(const SpgOptions &options,
                                const NodalState &nodes, const BondList &bonds,
                                const ParticleFields &fields,
                                const BondFailure &failure,
                                const GlobalIndex n_global,
                                MPI_Comm communicator);
} // namespace sabot

#endif
