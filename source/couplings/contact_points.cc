// Forces of spring and friction on all contact points of a step.
#include "sabot/couplings/contact_points.h"

#include "sabot/couplings/shared_work.h"

#include <cmath>

namespace sabot
{
namespace
{
Vec sliding(const ContactPoint &p)
{
  return p.velocity - dot(p.velocity, p.normal) * p.normal;
}

/** 2 zeta sqrt(k m) [N s/m] */
double damping(const ContactPoint &p, const ContactOptions &options)
{
  return 2. * options.damping_fraction *
         std::sqrt(p.stiffness * p.reduced_mass);
}

/** Friction on the node below @p largest [N]. */
Vec friction_of(const ContactPoint &p, const ContactOptions &options,
                const double largest, const double dt)
{
  if (p.memory != nullptr)
    return spring_friction(*p.memory, p.normal, p.velocity, p.depth,
                           p.stiffness, damping(p, options), largest, dt);
  const Vec v = sliding(p);
  const double speed = norm(v);
  return speed > 0. ? -std::min(largest / speed, 0.5 * p.reduced_mass / dt) * v
                    : Vec{};
}
} // namespace

void ContactPoints::find_forces(const ContactOptions &options, const double dt,
                                SharedWork *const work)
{
  const std::size_t n = points.size();
  if (work != nullptr)
    work->stiffen(points);
  contacts.pressing.resize(n);
  contacts.speed.resize(n);
  contacts.area.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    ContactPoint &p = points[i];
    p.pressing = p.stiffness * p.depth +
                 damping(p, options) * std::max(0., -dot(p.velocity, p.normal));
    p.friction = Vec{};
    contacts.pressing[i] = p.pressing;
    contacts.speed[i] = norm(sliding(p));
    contacts.area[i] = p.area;
  }
  if (options.friction)
  {
    largest.assign(n, 0.);
    options.friction->find_friction(contacts, largest);
    for (std::size_t i = 0; i < n; ++i)
      points[i].friction =
          friction_of(points[i], options,
                      std::min(largest[i], points[i].largest_friction), dt);
  }
  for (ContactPoint &p : points)
    p.part = p.fade;
  if (work != nullptr)
    work->back(points, dt);
}
} // namespace sabot
