// The pieces of a body, until its bonds change.
#include "sabot/bodies/spg/failure/known_pieces.h"

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/fragments.h"

namespace sabot
{
bool KnownPieces::is_present(Changes &made, const SpgParts &body)
{
  const Changes now = {body.bonds.n_changes(), body.failure.n_changes()};
  const bool is_known = made == now;
  made = now;
  return is_known;
}

const std::vector<GlobalIndex> &KnownPieces::labels(const SpgParts &body,
                                                    MPI_Comm communicator)
{
  if (!is_present(labels_made, body))
    label = fragment_labels(body.nodes, body.bonds, body.failure, body.exchange,
                            communicator);
  return label;
}

const std::vector<unsigned int> &
KnownPieces::planes(const SpgParts &body,
                    const std::vector<SymmetryPlane> &planes,
                    const double tolerance)
{
  if (!is_present(planes_made, body))
    plane_bits = planes_of_particles(body.nodes, body.bonds, body.failure,
                                     planes, tolerance);
  return plane_bits;
}
} // namespace sabot
