// What all bodies do alike.
#include "sabot/bodies/body.h"

#include "sabot/bodies/velocity_constraints.h"

#include <algorithm>

namespace sabot
{
void Body::add_kick_energy(const double dt, ExactSum &sum) const
{
  if (prescribed_velocities != nullptr)
    prescribed_velocities->add_kick_energy(nodal_state, dt, sum);
}

BodyMeasures measure_with_particles(const Body &body)
{
  BodyMeasures sum = body.measure();
  if (body.own_particles == nullptr)
    return sum;
  const BodyMeasures more = body.own_particles->measure();
  if (!(more.mass > 0.))
    return sum;
  const double mass = sum.mass + more.mass;
  for (int d = 0; d < 3; ++d)
  {
    sum.velocity[d] =
        (sum.mass * sum.velocity[d] + more.mass * more.velocity[d]) / mass;
    sum.low[d] = std::min(sum.low[d], more.low[d]);
    sum.high[d] = std::max(sum.high[d], more.high[d]);
  }
  sum.mass = mass;
  sum.kinetic_energy += more.kinetic_energy;
  return sum;
}
} // namespace sabot
