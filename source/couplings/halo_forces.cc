// Forces of a contact at the slots of its halo, and their work.
#include "sabot/couplings/halo_forces.h"

#include <algorithm>

namespace sabot
{
void HaloForces::resize(const std::size_t n)
{
  normal.assign(n, Vec{});
  friction.assign(n, Vec{});
  total.assign(n, Vec{});
}

void HaloForces::clear()
{
  std::fill(normal.begin(), normal.end(), Vec{});
  std::fill(friction.begin(), friction.end(), Vec{});
}

void HaloForces::add_to_bodies(const NodeHalo &halo)
{
  for (std::size_t s = 0; s < total.size(); ++s)
    total[s] = normal[s] + friction[s];
  halo.add_to_bodies(total);
}

void HaloForces::accumulate_work(const NodeHalo &halo, const double half_dt)
{
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    if (norm_square(normal[s]) > 0.)
    {
      const Vec v = half_dt * halo.body_velocity(s);
      contact_work.add(dot(normal[s], v));
      friction_work.add(dot(friction[s], v));
    }
}

void HaloForces::add_energies(EnergyLedger &ledger) const
{
  ledger.contact.subtract(contact_work);
  ledger.friction.subtract(friction_work);
}

void HaloForces::add_measures(Measures &measures, MPI_Comm communicator) const
{
  ExactSum work[2] = {contact_work, friction_work};
  ExactSum::reduce({&work[0], &work[1]}, communicator);
  measures.push_back({"contact energy", "J", -work[0].value()});
  measures.push_back({"friction energy", "J", -work[1].value()});
}

void HaloForces::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("contact work", contact_work);
  visitor.visit_value("friction work", friction_work);
  // Half of their work along the next step is still to be counted.
  visitor.visit_array("normal force", normal);
  visitor.visit_array("friction force", friction);
}
} // namespace sabot
