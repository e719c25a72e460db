// The energy balance of a scene.
#include "sabot/base/ledger.h"

#include <vector>

namespace sabot
{
const std::array<EnergyTerm, 14> energy_terms = {{
    {"kinetic", EnergyTerm::Role::part, "1/2 m v^2 of all nodes.",
     &EnergyLedger::kinetic},
    {"internal", EnergyTerm::Role::part,
     "Work of the stresses, trapezoidal in time: elastic energy, plastic work "
     "and bulk viscosity.",
     &EnergyLedger::internal},
    {"stabilization", EnergyTerm::Role::part,
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
     "Work done on the scene from outside, by loads and prescribed motion.",
     &EnergyLedger::external},
    {"plastic work", EnergyTerm::Role::information,
     "Part of internal that plastic flow dissipated.",
     &EnergyLedger::plastic_work},
    {"failure", EnergyTerm::Role::information,
     "Part of internal and stabilization that failed bonds and cracks let go: "
     "neither motion nor any body's elastic energy gets it back.",
     &EnergyLedger::failure},
    {"rubble friction", EnergyTerm::Role::information,
     "Part of internal and stabilization that failed metal turned into heat by "
     "friction between its pieces.",
     &EnergyLedger::rubble_friction},
    {"tie", EnergyTerm::Role::part,
     "Minus the work of the ties on followers and leaders together: zero but "
     "for round-off.",
     &EnergyLedger::tie},
    {"conversion", EnergyTerm::Role::part,
     "What cells that turned into particles held and particles do not: "
     "hourglass energy, and what means of stresses hold less than the "
     "stresses.",
     &EnergyLedger::conversion},
    {"added mass", EnergyTerm::Role::supplied,
     "Kinetic energy that mass scaling's added mass had when it came.",
     &EnergyLedger::added_mass},
}};

ExactSum EnergyLedger::total() const
{
  ExactSum sum;
  for (const EnergyTerm &term : energy_terms)
    if (term.role == EnergyTerm::Role::part)
      sum.add(this->*term.sum);
    else if (term.role == EnergyTerm::Role::supplied)
      sum.subtract(this->*term.sum);
  return sum;
}

void EnergyLedger::reduce(MPI_Comm communicator)
{
  std::vector<ExactSum *> sums;
  for (const EnergyTerm &term : energy_terms)
    sums.push_back(&(this->*term.sum));
  ExactSum::reduce(sums, communicator);
}
} // namespace sabot
