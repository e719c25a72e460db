// The spring that all contacts share: its entries, and the work that backs it.
#include "sabot/couplings/contact_spring.h"

#include "sabot/base/parameters.h"

#include <cmath>

namespace sabot
{
void SpringOptions::declare_parameters(Parameters &prm)
{
  prm.declare_knob("Damping fraction", "0.1", quantity(Dimension::none, 0., 1.),
                   "Of critical, while two nodes approach.");
  prm.declare_knob("Stiffness scale", "1", quantity(Dimension::none, 1e-3, 10.),
                   "Penalty stiffness over bulk modulus times spacing.");
}

void SpringOptions::parse_parameters(const Parameters &prm)
{
  damping_fraction = get_quantity(prm, "Damping fraction");
  stiffness_scale = get_quantity(prm, "Stiffness scale");
}

SpringClaim claim_of(ContactMemory &memory, const AskingSpring &spring,
                     const double dt)
{
  const Vec first = spring.first_velocity != nullptr ? *spring.first_velocity
                                                     : spring.velocity;
  memory.stored -= 0.5 * dot(memory.spring, first) * dt;
  const double square = norm_square(spring.force),
               work = dot(spring.force, spring.velocity) * dt,
               kick = 0.5 * square * dt * dt / spring.reduced_mass,
               phi = std::min(0.5,
                              spring.stiffness * dt * dt / spring.reduced_mass);
  double available = memory.stored + spring.lent;
  if (available > 0. && square > 0.)
  {
    // k d^2/2, and k (v_n dt)^2/2 with v_n along the force.
    const double held = 0.5 * square / spring.stiffness,
                 motion = 0.5 * spring.stiffness * work * work / square;
    available += std::min(1., available / held) * motion / (1. - phi);
  }
  return {work, kick, available};
}

double part_of(const SpringClaim &claim)
{
  const double work = claim.work, kick = claim.kick,
               available = std::max(0., claim.available);
  if (!(work + kick > available))
    return 1.;
  const double root = std::sqrt(work * work + 4. * kick * available);
  return work > 0. ? 2. * available / (work + root)
                   : 0.5 * (root - work) / kick;
}

void give(ContactMemory &memory, const AskingSpring &spring,
          const SpringClaim &claim, const double part)
{
  memory.stored -= 0.5 * part * claim.work;
  memory.spring = part * spring.force;
}

double backed_part(ContactMemory &memory, const AskingSpring &spring,
                   const double dt)
{
  const SpringClaim claim = claim_of(memory, spring, dt);
  const double part = part_of(claim);
  give(memory, spring, claim, part);
  return part;
}
} // namespace sabot
