#ifndef verification_balance_h
#define verification_balance_h

#include "verification/world.h"

namespace sabot
{
/** Follows the largest deviation of the balance from its first value, over the
    largest balance so far, as a run does. */
class EnergyWatch
{
public:
  explicit EnergyWatch(const World &world)
      : world(world), first(world.total_energy()), largest(std::abs(first))
  {
  }
  void look()
  {
    const double now = world.total_energy();
    largest = std::max(largest, std::abs(now));
    // Written so that not-a-number stays.
    const double off = std::abs(now - first) / largest;
    if (!(off <= worst))
      worst = off;
  }
  /** Largest residual seen; not-a-number for ever once a balance was. */
  double residual() const { return worst; }

private:
  const World &world;
  const double first;
  double largest, worst = 0.;
};

/** Whether all positions and velocities are numbers. */
inline bool is_finite(const World &world)
{
  for (const auto &body : world.bodies)
  {
    const NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      for (int d = 0; d < 3; ++d)
        if (!std::isfinite(n.position[i][d]) ||
            !std::isfinite(n.velocity[i][d]))
          return false;
  }
  return true;
}
} // namespace sabot

#endif
