// What all bodies do alike.
#include "sabot/bodies/body.h"

#include "sabot/bodies/velocity_constraints.h"

namespace sabot
{
void Body::add_kick_energy(const double dt, ExactSum &sum) const
{
  if (prescribed_velocities != nullptr)
    prescribed_velocities->add_kick_energy(nodal_state, dt, sum);
}
} // namespace sabot
