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

void SharedWork::ask(std::vector<ContactPoint> &points, const double dt)
{
  asked.clear();
  for (ContactPoint &p : points)
  {
    const double stiffer = pots[p.pair].stiffer;
    Asked asking;
    asking.is_new = norm_square(p.memory->spring) == 0.;
    asking.spring = {p.fade * p.stiffness * p.depth * p.normal,
                     p.velocity,
                     p.stiffness * p.fade,
                     p.reduced_mass,
                     (stiffer - 1.) * energy_of(p, stiffer),
                     &p.first_velocity};
    asking.claim = claim_of(*p.memory, asking.spring, dt);
    asking.part = part_of(asking.claim);
    asked.push_back(asking);
  }
}

void SharedWork::share_between_places(const std::vector<ContactPoint> &points)
{
  if (std::none_of(pots.begin(), pots.end(),
                   [](const Pot &pot) { return pot.n_places > 0.; }))
    return;
  struct Forces
  {
    ExactSum full, backed, friction; // [N]
    ExactSum work, kick, available;  // of all claims [J]
  };
  std::vector<Forces> forces(pots.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].is_place() && points[i].is_owned)
    {
      const double f = norm(asked[i].spring.force);
      Forces &sum = forces[points[i].pair];
      sum.full.add(f);
      sum.friction.add(norm(points[i].friction));
      sum.backed.add(asked[i].part * f);
      sum.work.add(asked[i].claim.work);
      sum.kick.add(asked[i].claim.kick);
      sum.available.add(asked[i].claim.available);
    }
  std::vector<ExactSum *> all;
  for (Forces &f : forces)
    all.insert(all.end(), {&f.full, &f.backed, &f.friction, &f.work, &f.kick,
                           &f.available});
  ExactSum::reduce(all, communicator);
  constexpr double none = -1.;
  std::vector<double> part(pots.size(), none);
  for (std::size_t i = 0; i < pots.size(); ++i)
    if (pots[i].n_places > 0. && forces[i].full.value() > 0. &&
        !(forces[i].friction.value() > 0.))
      part[i] =
          std::min(forces[i].backed.value() / forces[i].full.value(),
                   part_of({forces[i].work.value(), forces[i].kick.value(),
                            forces[i].available.value() + pots[i].owed()}));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].is_place() && part[points[i].pair] != none)
      asked[i].part = part[points[i].pair];
}

void SharedWork::back(std::vector<ContactPoint> &points, const double dt)
{
  ask(points, dt);
  share_between_places(points);
  std::vector<Sums> sums(pots.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ContactPoint &p = points[i];
    const double energy = energy_of(p, pots[p.pair].stiffer);
    ContactMemory &memory = *p.memory;
    give(memory, asked[i].spring, asked[i].claim, asked[i].part);
    p.part = p.fade * asked[i].part;
    // What a node takes on the way in beyond this it gives on the way out, in
    // the step that leaves the other side.
    if (asked[i].is_new)
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
      if (p.is_place())
        sum.places.add(1.);
    }
    memory.stored = own;
  }
  fill(points, sums);
}

void SharedWork::fill(std::vector<ContactPoint> &points,
                      std::vector<Sums> &sums)
{
  std::vector<ExactSum *> all;
  for (Sums &sum : sums)
    all.insert(all.end(), {&sum.held, &sum.lacking, &sum.surplus, &sum.damped,
                           &sum.places});
  ExactSum::reduce(all, communicator);
  std::vector<double> filled(pots.size()), stiffer(pots.size());
  for (std::size_t i = 0; i < pots.size(); ++i)
  {
    stiffer[i] = pots[i].stiffer;
    filled[i] = pots[i].share(sums[i].held.value(), sums[i].lacking.value(),
                              sums[i].surplus.value(), sums[i].damped.value());
    pots[i].n_places = sums[i].places.value();
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
