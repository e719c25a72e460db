#ifndef sabot_bodies_spg_failure_crumbled_neighbors_h
#define sabot_bodies_spg_failure_crumbled_neighbors_h

#include "sabot/bodies/spg/bond_list.h"

#include <mpi.h>

namespace sabot
{
class BondFailure;
class LagrangianKernel;
class MirrorPlanes;
struct NodalState;

/**
 * Rows of neighbors, ascending global numbers [n_owned], in which the bonds
 * between crumbled particles are those of now: pairs closer than the support
 * of an undeformed kernel, normalized support times the mean spacing [m]. All
 * other bonds are as they were, without those that have failed now. Images
 * beyond planes of symmetry are crumbs like others.
 * Collective; an all-gather of 64 bytes per
 * crumbled particle of the body, cubes of one support.
 *
 * Metal without cohesion has no memory of its neighbors: a list of the start
 * would lose them as pieces slide on, and the volume between them.
 */
BondList::Rows renew_crumbled_neighbors(const NodalState &nodes,
                                        const BondList &bonds,
                                        const BondFailure &failure,
                                        const LagrangianKernel &kernel,
                                        const MirrorPlanes &mirror,
                                        MPI_Comm communicator);
} // namespace sabot

#endif
