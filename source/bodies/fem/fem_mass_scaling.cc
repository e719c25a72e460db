// The smallest step of a body of hexahedra: inertia for cells that ask for
// less.
#include "sabot/bodies/fem/fem_mass_scaling.h"

#include <cmath>

namespace sabot
{
bool FemMassScaling::hold(const unsigned int, const double dt)
{
  StableStep shortest;
  cells.smallest_step = StableStep();
  const auto note =
      [&](StableStep &least, const double step, const std::size_t e)
  {
    if (step < least.dt)
      least = {step, cells.cell_id[e]};
  };
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    const double own = cells.cell_step[e], needed = share_for(own);
    double &share = cells.added_share[e];
    if (needed > share)
    {
      const double more = 0.125 * (needed - share) * density * cells.volume[e];
      for (const std::uint32_t a : cells.connectivity[e])
        add(a, more, dt);
      share = needed;
    }
    note(shortest, own, e);
    note(cells.smallest_step, own * std::sqrt(1. + share), e);
  }
  return settle(shortest);
}
} // namespace sabot
