// Force and impulse of mirror images on a body of particles.
#include "sabot/bodies/spg/image_reaction.h"

#include "sabot/base/exact_sum.h"

namespace sabot
{
void ImageReaction::settle(const AlignedVector<Vec> &own)
{
  if (waiting == 0.)
    return;
  for (std::size_t i = 0; i < impulse.size(); ++i)
    impulse[i] += waiting * own[i];
  waiting = 0.;
}

Resultant ImageReaction::resultant(const int body,
                                   const AlignedVector<Vec> &own,
                                   MPI_Comm communicator) const
{
  ExactSum force[3], total[3];
  for (int d = 0; d < 3; ++d)
  {
    ExactTerms forces(force[d]), impulses(total[d]);
    for (std::size_t i = 0; i < impulse.size() && axes >> d & 1; ++i)
    {
      forces.add(own[i][d]);
      impulses.add(impulse[i][d] + waiting * own[i][d]);
    }
  }
  ExactSum::reduce(
      {&force[0], &force[1], &force[2], &total[0], &total[1], &total[2]},
      communicator);
  Resultant sum{"symmetry faces", body, {}, {}, true};
  for (int d = 0; d < 3; ++d)
  {
    sum.force[d] = force[d].value();
    sum.impulse[d] = total[d].value();
  }
  return sum;
}
} // namespace sabot
