// The energy balance of a scene.
#include "sabot/base/ledger.h"

#include <vector>

namespace sabot
{
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
