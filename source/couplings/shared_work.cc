// The work that the springs between two bodies took: who may give it back.
#include "sabot/couplings/shared_work.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** With the bound of the stiffness, a fraction of 0.1 of m/dt^2, far from the
    limit of central differences. */
constexpr double stiffest = 2.;

/** k d^2/2 of the part that acts [J], of its own stiffness. */
double energy_of(const ContactPoint &p, const double stiffer)
{
  return 0.5 * p.fade * p.stiffness / stiffer * p.depth * p.depth;
}
} // namespace

SharedWork::SharedWork(const std::vector<std::pair<int, int>> &of_bodies,
                       MPI_Comm communicator)
    : communicator(communicator)
{
  for (const auto &[a, b] : of_bodies)
    pairs.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  pots.resize(pairs.size());
}

int SharedWork::number_of(const int a, const int b) const
{
  return std::lower_bound(pairs.begin(), pairs.end(),
                          std::make_pair(std::min(a, b), std::max(a, b))) -
         pairs.begin();
}

void SharedWork::stiffen(std::vector<ContactPoint> &points) const
{
  for (ContactPoint &p : points)
    p.stiffness *= pots[p.pair].stiffer;
}

void SharedWork::back(std::vector<ContactPoint> &points, const double dt)
{
  std::vector<Sums> sums(pots.size());
  for (ContactPoint &p : points)
  {
    const double stiffer = pots[p.pair].stiffer, energy = energy_of(p, stiffer);
    ContactMemory &memory = *p.memory;
    const bool is_new = norm_square(memory.spring) == 0.;
    p.part =
        p.fade * backed_part(memory,
                             {p.fade * p.stiffness * p.depth * p.normal,
                              p.velocity, p.stiffness * p.fade, p.reduced_mass,
                              (stiffer - 1.) * energy, &p.first_velocity},
                             dt);
    // What a node takes on the way in beyond this it gives on the way out, in
    // the step that leaves the other side.
    if (is_new)
      memory.stored = std::min(memory.stored, energy);
    const double own = std::clamp(memory.stored, 0., energy);
    const Vec before = memory.damping;
    memory.damping = p.part * (p.pressing - p.stiffness * p.depth) * p.normal;
    if (p.is_owned)
    {
      Sums &sum = sums[p.pair];
      sum.held.add(energy);
      sum.surplus.add(memory.stored - own);
      sum.lacking.add(energy - own);
      sum.damped.add(
          -0.5 *
          (dot(before, p.first_velocity) + dot(memory.damping, p.velocity)) *
          dt);
    }
    memory.stored = own;
  }
  std::vector<ExactSum *> all;
  for (Sums &sum : sums)
    all.insert(all.end(), {&sum.held, &sum.lacking, &sum.surplus, &sum.damped});
  ExactSum::reduce(all, communicator);
  std::vector<double> filled(pots.size()), stiffer(pots.size());
  for (std::size_t i = 0; i < pots.size(); ++i)
  {
    stiffer[i] = pots[i].stiffer;
    filled[i] = pots[i].share(sums[i].held.value(), sums[i].lacking.value(),
                              sums[i].surplus.value(), sums[i].damped.value());
  }
  for (ContactPoint &p : points)
    p.memory->stored +=
        filled[p.pair] * (energy_of(p, stiffer[p.pair]) - p.memory->stored);
}

double SharedWork::Pot::share(const double held, const double lacking,
                              const double surplus, const double damped)
{
  left += surplus;
  lost += damped;
  // Of bodies that have parted nothing is known.
  const double most = (stiffest - 1.) * held,
               available = std::max(0., left + lost),
               given = std::min(lacking, available);
  left -= given;
  if (left > most)
  {
    lost += left - most;
    left = most;
  }
  else if (left < 0.)
  {
    lost += left;
    left = 0.;
  }
  stiffer = held > 0. ? 1. + left / held : 1.;
  return lacking > 0. ? given / lacking : 0.;
}

void SharedWork::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("shared work", pots);
}
} // namespace sabot
