#ifndef sabot_base_ledger_h
#define sabot_base_ledger_h

#include "sabot/base/exact_sum.h"

#include <mpi.h>

#include <array>

namespace sabot
{
/**
 * Where the energy is [J]. Bodies and couplings add their rank's share, term by
 * term; reduce() makes it the scene's. What the terms mean stands in
 * energy_terms, the one list from which the history, result.json, the balance
 * and the manual are made.
 *
 * At one moment, not of a step: work terms are what has been summed up since
 * the start of the run. Kinetic energy is 1/2 m v^2 with the masses that move:
 * lumped ones and what mass scaling added; internal that of the stresses' work.
 */
struct EnergyLedger
{
  ExactSum kinetic, internal, stabilization, hourglass, contact, friction,
      eroded, external, plastic_work, failure, rubble_friction, tie, conversion,
      added_mass;

  /**
   * Sum of all parts less what was supplied from outside: constant but for the
   * error of the method. Exact, whatever the order of terms.
   *   sum of parts - sum of supplied,
   * terms that are information only left out. The balance compares it with its
   * value at the start.
   */
  ExactSum total() const;
  /**
   * Add up over ranks. Collective.
   * One message for all terms; the bits are the same for every number of ranks.
   */
  void reduce(MPI_Comm communicator);
  /**
   * Call @p f(term, value in J) for each of energy_terms, in order.
   * Terms as they are on this rank, so call reduce() before.
   */
  template <typename Function>
  void for_each(const Function &f) const;
};

/**
 * A term of the ledger.
 * A new one is a member of EnergyLedger and a line of energy_terms.
 */
struct EnergyTerm
{
  enum class Role
  {
    part,       // of the scene's energy
    supplied,   // work done on the scene, which the balance takes off
    information // contained in other terms
  };
  const char *name; // column of the history, key of result.json
  Role role;
  const char *meaning;
  ExactSum EnergyLedger::*sum;
};

/** Every term once, in the order of the history's columns. */
extern const std::array<EnergyTerm, 14> energy_terms;

template <typename Function>
void EnergyLedger::for_each(const Function &f) const
{
  for (const EnergyTerm &term : energy_terms)
    f(term, (this->*term.sum).value());
}
} // namespace sabot

#endif
