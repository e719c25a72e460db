#ifndef verification_balance_h
#define verification_balance_h

#include "verification/world.h"

namespace sabot
{
/** Energy of a world with all parts of the ledger, less the work done on it
    from outside; on one rank. */
inline double balance(const World &world)
{
  EnergyLedger e;
  for (const auto &body : world.bodies)
    body->add_energies(e);
  for (const auto &coupling : world.couplings)
    coupling->add_energies(e);
  return e.total().value();
}

/** Follows the largest deviation of the balance from its first value, over the
    largest balance so far, as a run does. */
class EnergyWatch
{
public:
  explicit EnergyWatch(const World &world)
      : world(world), first(balance(world)), largest(std::abs(first))
  {
  }
  void look()
  {
    const double now = balance(world);
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

/** 6061-T6 of prm/materials/al6061-t6.prm. */
inline std::shared_ptr<JohnsonCook>
aluminium_6061(const ElasticBase::Eos &eos = {})
{
  JohnsonCookParameters p;
  p.A = 324e6;
  p.B = 114e6;
  p.n = 0.42;
  p.C = 0.002;
  p.m = 1.34;
  p.melt_temperature = 925.;
  p.specific_heat = 896.;
  return std::make_shared<JohnsonCook>(ElasticConstants{2700., 68.9e9, 0.33}, p,
                                       eos);
}
} // namespace sabot

#endif
