#ifndef sabot_base_ledger_h
#define sabot_base_ledger_h

#include "sabot/base/exact_sum.h"

namespace sabot
{
/**
 * Where the energy is [J]. Internal energy is the work of the stresses
 * (trapezoidal in time), so it holds elastic energy, plastic work and bulk
 * viscosity; contact is minus the work of the contact forces without their
 * tangential part, which is friction. External is the work done on the scene.
 */
struct EnergyLedger
{
  ExactSum kinetic, internal, stabilization, hourglass, contact, friction,
      external;
  /** Of eroded cells and of nodes that lost all their cells: still energy of
      the scene, but out of reach of its bodies. */
  ExactSum eroded;
  /** Minus the work of the ties on followers and leaders together: zero but
      for round-off. */
  ExactSum tie;
  /** Part of internal that was dissipated by plastic flow (information). */
  ExactSum plastic_work;
  /** Part of internal and stabilization that failed bonds and cracks let go:
      neither motion nor any body's elastic energy gets it back
      (information). */
  ExactSum failure;
};
} // namespace sabot

#endif
