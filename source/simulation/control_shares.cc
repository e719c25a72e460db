// The share of hourglass control and stabilization in a body's energy.
#include "sabot/simulation/control_shares.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void ControlShares::look(const std::size_t body, const BodyMeasures &measures)
{
  Largest &largest = bodies[body];
  largest.control =
      std::max(largest.control, std::abs(measures.control_energy));
  largest.internal = std::max(largest.internal, measures.internal_energy);
}

double ControlShares::share(const std::size_t body) const
{
  const Largest &largest = bodies[body];
  return largest.control == 0.
             ? 0.
             : largest.control / std::max(largest.internal, 1e-300);
}

bool ControlShares::is_large(const std::size_t body,
                             const double scene_energy) const
{
  return share(body) > most && bodies[body].control > 1e-4 * scene_energy;
}
} // namespace sabot
