// Forces of spring and friction on all contact points of a step.
#include "sabot/couplings/contact_points.h"

#include <cmath>

namespace sabot
{
void ContactPoints::find_forces(const ContactOptions &options, const double dt)
{
  const std::size_t n = points.size();
  contacts.pressing.resize(n);
  contacts.speed.resize(n);
  contacts.area.resize(n);
  friction.assign(n, 0.);
  for (std::size_t i = 0; i < n; ++i)
  {
    ContactPoint &p = points[i];
    const double normal_rate = dot(p.velocity, p.normal);
    const double damping = 2. * options.damping_fraction *
                           std::sqrt(p.stiffness * p.reduced_mass) *
                           std::max(0., -normal_rate);
    p.pressing = p.stiffness * p.depth + damping;
    p.sliding = p.velocity - normal_rate * p.normal;
    contacts.pressing[i] = p.pressing;
    contacts.speed[i] = norm(p.sliding);
    contacts.area[i] = p.area;
  }
  if (options.friction)
    options.friction->find_friction(contacts, friction);
  for (std::size_t i = 0; i < n; ++i)
  {
    ContactPoint &p = points[i];
    const double speed = contacts.speed[i];
    // Friction cannot do more than stop the sliding within the step.
    p.drag = speed > 0. ? std::min({friction[i], p.largest_friction,
                                    0.5 * p.reduced_mass * speed / dt}) /
                              speed
                        : 0.;
    p.part = p.fade;
    if (p.memory != nullptr)
      p.part = p.fade * backed_part(*p.memory,
                                    p.fade * p.stiffness * p.depth * p.normal,
                                    p.velocity, p.stiffness, dt);
  }
}
} // namespace sabot
