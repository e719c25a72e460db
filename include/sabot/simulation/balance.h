#ifndef sabot_simulation_balance_h
#define sabot_simulation_balance_h

#include "sabot/simulation/scene.h"

#include <array>
#include <string>

namespace sabot
{
/**
 * Watches what a run must keep: energy, and the momentum of a free scene.
 * Residuals are relative to the largest energy that passed through so far and
 * to the momentum that the bodies had at the start, sum over bodies of
 * sqrt(2 E_kin m). With the total energy E, of which the work supplied from
 * outside has been taken off (EnergyLedger::total()), and the energy E_kick
 * that whole steps have over half ones (Body::add_kick_energy()), energy:   |E
 * - E_kick - E_0 + E_kick,0|/max over time of (sum |parts|, |supplied|),
 * momentum: |sum m v + p_eroded + p_added - p_0|/sum sqrt(2 E_kin m), both pure
 * numbers; p_added is the momentum that mass scaling's mass won since it came.
 * A bar that is driven from rest so counts against the work put in. Where
 * nothing moves, energies count against those of a motion of 1e-10 of the speed
 * of sound, so that round-off is none.
 */
class EnergyBalance
{
public:
  /** The scene is kept by reference, and may still be without state. */
  EnergyBalance(const Scene &scene, MPI_Comm communicator);

  /**
   * Take the present values for those that must stay. Collective.
   * After the first forces, before the first step.
   */
  void start();
  /**
   * Look now, at @p time [s] after a step of @p dt [s]; 0: before the first.
   * Collective.
   * A residual that is not a number counts as the largest one.
   */
  void look(const double time, const double dt);
  /**
   * Throws PhysicsError when the energy residual is above @p limit; says which
   * term is largest and, by @p limiter, what limited the step.
   * Of the last look; a residual that is not a number is above any limit. Not
   * collective, but the same on all ranks, as the sums are.
   */
  void check(const double limit, const std::string &limiter) const;
  /** The last step is cut: kicks had the energy @p before, and have the energy
      @p after, by the same forces [J]. */
  void cut(const double before, const double after)
  {
    cut_kick = after - before;
  }
  /** By Body::add_kick_energy() with a step of @p dt [s], and what loads take
      off again [J]. Collective. */
  double kick_energy(const double dt) const;
  /** Fill row() with the values of a resumed run, leaving all else. */
  void fill_row(const double time, const double dt);
  /**
   * Initial and largest values: a resumed run measures against the same ones.
   */
  void visit_state(StateVisitor &visitor);

  /** Time, step size, all terms of the ledger, total and residual. */
  const Measures &row() const { return ledger; }
  /** Most energy that passed through so far [J]. */
  double energy_scale() const { return largest_energy; }
  double last_residual() const { return last; }
  double largest_residual() const { return largest; }
  double largest_momentum_residual() const { return largest_momentum; }

private:
  /** Fills the ledger. @return E - E_kick [J] after a step of @p dt [s]. */
  double total_energy(const double dt);
  double momentum_residual() const;

  const Scene &scene;
  MPI_Comm communicator;
  Measures ledger;
  double initial_energy = 0., largest_energy = 0.; // [J]
  double passed = 0., least_energy = 0.;           // [J]
  static constexpr double kick_step = 1e-6;        // [s], of the next one
  double initial_kick = 0.; // energy of kicks by the first forces [J]
  double first_step = 0.;   // [s]
  double cut_kick = 0.;     // by which the cut of the last step changes it [J]
  double last = 0., largest = 0.;
  std::array<double, 3> initial_momentum{}; // [kg m/s]
  double momentum_scale = 0., largest_momentum = 0.;
};
} // namespace sabot

#endif
