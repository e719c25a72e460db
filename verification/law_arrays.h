#ifndef verification_law_arrays_h
#define verification_law_arrays_h

#include "sabot/materials/material.h"

namespace sabot
{
/** What an update by a law reads and writes, for up to a full batch of points:
    all zero at first. May be copied. */
struct LawArrays
{
  static constexpr std::size_t most = max_batch_points;

  /** @p n points, a step of @p dt [s], the law's own @p states. */
  MaterialBatch batch(const Material &law, const std::size_t n, const double dt,
                      double *const *states)
  {
    MaterialBatch all;
    all.n = n;
    all.dt = dt;
    for (int c = 0; c < 6; ++c)
    {
      all.stress[c] = stress[c];
      all.strain_increment[c] = strain[c];
    }
    all.jacobian = jacobian;
    all.states = states;
    all.extra_square = extra;
    all.return_factor = factor;
    all.plastic_work = work;
    all.viscous_pressure = viscous;
    if (law.needs_deformation_gradient())
      for (int c = 0; c < 9; ++c)
        all.deformation_gradient[c] = F[c];
    if (law.stiffens())
      all.stiffening = stiffening;
    return all;
  }

  double stress[6][most] = {}, strain[6][most] = {}, F[9][most] = {};
  double jacobian[most] = {}, extra[most] = {}, factor[most] = {},
         work[most] = {}, viscous[most] = {}, stiffening[most] = {};
};
} // namespace sabot

#endif
