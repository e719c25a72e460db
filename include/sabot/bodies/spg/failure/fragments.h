#ifndef sabot_bodies_spg_failure_fragments_h
#define sabot_bodies_spg_failure_fragments_h

#include "sabot/base/types.h"
#include "sabot/bodies/body.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
class BondFailure;
class BondList;
class ParticleExchange;

/** Label of the connected piece that each owned particle belongs to: the
    least global number in it, the same on every number of ranks. Collective.
    [n_owned]. Particles of a rank are joined by union-find along the bonds
    that have not failed, then labels go over the border of ranks until
    nothing changes; the number of rounds is that of the rank borders that a
    piece crosses. A particle without bonds is a piece of its own. */
std::vector<GlobalIndex> fragment_labels(const NodalState &nodes,
                                         const BondList &bonds,
                                         const BondFailure &failure,
                                         const ParticleExchange &exchange,
                                         MPI_Comm communicator);

/** Of each owned particle the @p planes, a bit each, in which it lay at the
    start, within @p tolerance [m], or across which bonds hold it to images of
    particles. Local. */
std::vector<unsigned int> planes_of_particles(
    const NodalState &nodes, const BondList &bonds, const BondFailure &failure,
    const std::vector<SymmetryPlane> &planes, const double tolerance);

/** The pieces themselves, heaviest first; masses [kg] and momenta are exact
    sums, so they do not depend on the number of ranks. Collective, the same
    on all ranks. label: of the owned particles, see fragment_labels().
    Velocity is sum m v / sum m [m/s] with the lumped masses. A piece with a
    particle of one of the @p planes of symmetry, @p at_planes as
    planes_of_particles() has them, goes on beyond it: twice the mass for each
    such plane, no velocity across it. */
std::vector<Fragment> find_fragments(const NodalState &nodes,
                                     const std::vector<GlobalIndex> &label,
                                     const std::vector<unsigned int> &at_planes,
                                     const std::vector<SymmetryPlane> &planes,
                                     MPI_Comm communicator);
} // namespace sabot

#endif
