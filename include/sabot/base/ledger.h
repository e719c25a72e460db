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
 */
struct EnergyLedger
{
  ExactSum kinetic, internal, stabilization, hourglass, contact, friction,
      eroded, external, plastic_work, failure, tie;

  /** Sum of all parts less what was supplied from outside: constant but for
      the error of the method. Exact, whatever the order of terms. */
  ExactSum total() const;
  /** Add up over ranks. Collective. */
  void reduce(MPI_Comm communicator);
  /** Call @p f(term, value in J) for each of energy_terms, in order. */
  template <typename Function>
  void for_each(const Function &f) const;
};

/** A term of the ledger. */
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

inline constexpr std::array<EnergyTerm, 11> energy_terms = {{
    {"kinetic", EnergyTerm::Role::part, "1/2 m v^2 of all nodes.",
     &EnergyLedger::kinetic},
    {"internal", EnergyTerm::Role::part,
     "Work of the stresses, trapezoidal in time: elastic energy, plastic work "
     "and bulk viscosity.",
     &EnergyLedger::internal},
    {"stabilisation", EnergyTerm::Role::part,
     "Work of the forces that stabilize particles.",
     &EnergyLedger::stabilization},
    {"hourglass", EnergyTerm::Role::part,
     "Work of the hourglass forces of one-point hexahedra.",
     &EnergyLedger::hourglass},
    {"contact", EnergyTerm::Role::part,
     "Minus the work of the contact forces without their tangential part.",
     &EnergyLedger::contact},
    {"friction", EnergyTerm::Role::part,
     "Minus the work of the tangential contact forces.",
     &EnergyLedger::friction},
    {"eroded", EnergyTerm::Role::part,
     "Energy of eroded cells and of nodes that lost all their cells: still of "
     "the scene, but out of reach of its bodies.",
     &EnergyLedger::eroded},
    {"external", EnergyTerm::Role::supplied,
     "Work done on the scene from outside, by prescribed motion.",
     &EnergyLedger::external},
    {"plastic work", EnergyTerm::Role::information,
     "Part of internal that plastic flow dissipated.",
     &EnergyLedger::plastic_work},
    {"failure", EnergyTerm::Role::information,
     "Part of internal and stabilization that failed bonds and cracks let go: "
     "neither motion nor any body's elastic energy gets it back.",
     &EnergyLedger::failure},
    {"tie", EnergyTerm::Role::part,
     "Minus the work of the ties on followers and leaders together: zero but "
     "for round-off.",
     &EnergyLedger::tie},
}};

template <typename Function>
void EnergyLedger::for_each(const Function &f) const
{
  for (const EnergyTerm &term : energy_terms)
    f(term, (this->*term.sum).value());
}
} // namespace sabot

#endif
