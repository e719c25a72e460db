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
  ExactVectorSum force, total;
  for (std::size_t i = 0; i < impulse.size(); ++i)
  {
    force.add(own[i]);
    total.add(impulse[i] + waiting * own[i]);
  }
  ExactVectorSum::reduce({&force, &total}, communicator);
  Resultant sum{"symmetry faces", body, force.value(), total.value(), true};
  for (int d = 0; d < 3; ++d)
    if (!(axes >> d & 1))
      sum.force[d] = sum.impulse[d] = 0.;
  return sum;
}
} // namespace sabot
