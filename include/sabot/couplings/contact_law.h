#ifndef sabot_couplings_contact_law_h
#define sabot_couplings_contact_law_h

#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
/** Penalty law of contact. */
struct ContactOptions
{
  /** Coulomb: mu = mu_d + (mu_s - mu_d) exp(-decay |sliding speed|). */
  double friction = 0.;         // mu_s
  double dynamic_friction = -1; // mu_d; negative: mu_s at all speeds
  double friction_decay = 0.;   // [s/m]
  /** Friction over the area of a node stays below this [Pa]; infinite: off. */
  double shear_limit = 1e300;
  /** As shear_limit, from the present flow stress of the softer side. */
  bool limit_by_yield = false;
  double damping_fraction = 0.1; // of critical, while approaching
  double stiffness_scale = 1.;   // of K h
  /** Largest stiffness as a fraction of reduced mass over dt^2. */
  double stability_fraction = 0.1;

  double friction_coefficient(const double speed) const
  {
    if (dynamic_friction < 0.)
      return friction;
    return dynamic_friction +
           (friction - dynamic_friction) * std::exp(-friction_decay * speed);
  }
  bool has_shear_limit() const { return limit_by_yield || shear_limit < 1e300; }
};

/**
 * What is known of a node's past contact. A node that is found inside without
 * having come in through a surface (at the start, or because the closest part
 * of it changed) repels only below the depth at which it was found: no energy
 * enters.
 */
struct ContactMemory
{
  Vec side = {};      // outward normal of the surface last met; zero: none yet
  double depth = -1.; // at the last step [m]; negative: not known
  double offset = 0.; // part of the depth that does not repel [m]
  /** Work that the spring has taken since they met and may give back [J], and
      its force on the node at the last step [N]. */
  double stored = 0.;
  Vec spring = {};

  void release()
  {
    depth = offset = stored = 0.;
    spring = Vec{};
  }

  /** Part of @p new_depth that repels. @p largest_change: by motion alone. */
  double effective_depth(const double new_depth, const double largest_change)
  {
    if (depth < 0.) // first seen
      offset = new_depth;
    else if (new_depth > depth + largest_change)
      offset += new_depth - depth;
    offset = std::min(offset, new_depth);
    depth = new_depth;
    return new_depth - offset;
  }
};

/**
 * Part of a spring's force that the work it has taken bears; keeps the books in
 * @p memory. Between crumbled or crumpled surfaces normals and weights change
 * with each other's disorder and k depth has no potential: a spring may push
 * its way apart further than it was pressed. It gives back what it took, and
 * what one step's motion is worth.
 * @param spring: on the node [N]; @p v: of the node against what it touches.
 */
inline double backed_part(ContactMemory &memory, const Vec spring, const Vec v,
                          const double k, const double dt)
{
  // The mean of two steps' forces along the way between them: of a constant
  // stiffness before a plane this is k depth^2/2 to round-off.
  const double work = 0.5 * dot(memory.spring + spring, v) * dt;
  const double available = memory.stored + 0.5 * k * norm_square(v) * dt * dt;
  const double part = work > available ? available / work : 1.;
  memory.stored = std::max(0., memory.stored - part * work);
  memory.spring = part * spring;
  return part;
}

/** Forces on a node that is held by a surface. */
struct ContactForces
{
  Vec normal, friction; // [N]
};

/**
 * Penalty, damping while approaching, and Coulomb friction on a node.
 * @param k, reduced_mass: of the spring between node and surface.
 * @param depth: that repels [m] > 0; @p v: of the node against the surface;
 *   @p n: unit normal of the surface.
 * @param largest_friction: that the material bears [N].
 */
inline ContactForces contact_forces(const ContactOptions &options,
                                    const double k, const double reduced_mass,
                                    const double depth, const Vec v,
                                    const Vec n, const double largest_friction,
                                    const double dt)
{
  const double normal_rate = dot(v, n);
  const double damping = 2. * options.damping_fraction *
                         std::sqrt(k * reduced_mass) *
                         std::max(0., -normal_rate);
  const double pressing = k * depth + damping;
  const Vec sliding = v - normal_rate * n;
  const double speed = norm(sliding);
  // Friction cannot do more than stop the sliding within the step.
  const double drag =
      speed > 0.
          ? std::min({options.friction_coefficient(speed) * pressing,
                      largest_friction, 0.5 * reduced_mass * speed / dt}) /
                speed
          : 0.;
  return {pressing * n, -drag * sliding};
}
} // namespace sabot

#endif
