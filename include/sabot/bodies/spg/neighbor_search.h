#ifndef sabot_bodies_spg_neighbor_search_h
#define sabot_bodies_spg_neighbor_search_h

#include "sabot/bodies/spg/bond_list.h"

#include <mpi.h>

namespace sabot
{
struct SpgParts;

/**
 * Rows of neighbors that the kernels of now reach, by the body's policy
 * (SpgOptions::NeighborPolicy): all pairs of which one lies in the kernel of
 * the other, but those whose bond failed; or the present bonds and those pairs
 * of particles without a failed bond. Every rank gets every particle: new
 * neighbors may come from anywhere. Collective.
 *
 * Rows [n_owned] of global numbers, ascending, for SpgBody::renumber().
 * Images beyond planes of symmetry are neighbors like others. Positions are the
 * present ones, kernels those of owned particles in fields.
 * One all-gather of about a hundred bytes per particle of the body, and buckets
 * of the longest semi-axis of any kernel [m]: to be done at kernel updates
 * only.
 */
BondList::Rows search_neighbors(const SpgParts &body, MPI_Comm communicator);
} // namespace sabot

#endif
