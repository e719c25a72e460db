#ifndef sabot_couplings_contact_spring_h
#define sabot_couplings_contact_spring_h

#include "sabot/kernels/vec.h"

#include <algorithm>

namespace sabot
{
class Parameters;

/**
 * The spring between a node and what it presses on, the same in all contacts:
 *
 *     f = max(0, k d + c v),  k = min(s K h, phi m/dt^2),  c = 2 zeta sqrt(k m)
 *
 * with the depth d [m], the speed of approach v = max(0, -v_n) [m/s], the bulk
 * modulus K of the softer side [Pa], the spacing h [m] and the reduced mass
 * 1/m = 1/m_node + sum w_j^2/m_j [1/kg] of the node and the parts w_j that the
 * touched nodes take. The bound phi m/dt^2 keeps the frequency of node and
 * surface below the limit 2/dt of central differences whatever the masses are
 * (doc/theory-coupling.md, "Stable step").
 */
struct SpringOptions
{
  double damping_fraction = 0.1; // zeta: of critical, while approaching
  double stiffness_scale = 1.;   // s
  /** phi: largest stiffness as a fraction of reduced mass over dt^2. Stability
      needs 4 less what the bodies need. */
  double stability_fraction = 0.1;

  static void declare_parameters(Parameters &prm);
  void parse_parameters(const Parameters &prm);

  /** k [N/m] of a spring that would like @p stiffness = s K h [N/m]. @p dt:
      the step just made [s], > 0. */
  double stable_stiffness(const double stiffness, const double reduced_mass,
                          const double dt) const
  {
    return std::min(stiffness, stability_fraction * reduced_mass / (dt * dt));
  }
};

/**
 * The step that bounds stiffnesses: at least the present one, and falling by no
 * more than a thousandth each time while it is within half of the present one:
 * steps of particles go up and down by a percent, and stiffnesses that followed
 * them would shake what rests. Steps that fall by more, as before rigid bodies
 * meet, are followed: a bound far behind would leave no stiffness. Not so the
 * last step of a run, which is cut to meet its end (keep()).
 */
class SteadyStep
{
public:
  /** @return the bound's step after one of @p dt [s]. */
  double follow(const double dt)
  {
    value = std::max(dt, is_kept ? value : std::min(0.999 * value, 1.5 * dt));
    is_kept = false;
    return value;
  }
  /** Whatever the next step is, it does not fall. */
  void keep() { is_kept = true; }
  double value = 0.; // [s]; goes into checkpoints

private:
  bool is_kept = false; // until the next step; nothing goes on from there
};

/**
 * What is known of a node's past contact. A node that is found inside without
 * having come in through a surface (at the start, or because the closest part
 * of it changed) repels only below the depth at which it was found: no energy
 * enters. Part of checkpoints, so plain numbers.
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
  Vec damping = {};  // on the node at the last step [N]
  Vec friction = {}; // on the node at the last step [N]

  /** The node is outside: it may come in anew. The side stays known. */
  void release()
  {
    depth = offset = stored = 0.;
    spring = damping = friction = Vec{};
  }

  /** Part of @p new_depth that repels [m].
      @param largest_change: of the depth by motion alone since the last step,
      2 |v| dt; what the depth grew beyond it came from another face and does
      not repel. */
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

/** A spring that asks how much of its force it may have. */
struct AskingSpring
{
  Vec force;           // k d n, on the node [N]
  Vec velocity;        // of the node against what it touches [m/s]
  double stiffness;    // k [N/m]
  double reduced_mass; // m [kg]
  double lent = 0.;    // that others have taken for it [J]
  /** At the start of the step [m/s]; null: the same. */
  const Vec *first_velocity = nullptr;
};

/**
 * Part of a spring's force, in [0, 1], that the work it has taken bears; keeps
 * the books in @p memory. Between crumbled or crumpled surfaces normals and
 * weights change with each other's disorder and k depth has no potential: a
 * spring may push its way apart further than it was pressed. It gives back what
 * it took, and what one step's motion is worth.
 *
 * The step just made moved the node by v dt along half of the last force, which
 * acted in full, and half of this one, so that a constant stiffness before a
 * plane has k depth^2/2 to round-off. The other half of this force, f, acts
 * along the next step, whose velocity it changes itself. Its part p is thus the
 * largest with
 *
 *     p f . v dt + (p f dt)^2/(2 m) <= stored + b k (v_n dt)^2/(2 (1 - phi)),
 *     b = min(1, stored/(k d^2/2)),   phi = k dt^2/m,
 *
 * which with stored = k d^2/2 holds p = 1 at any speed.
 * memory.stored becomes negative where the last force gave more.
 */
double backed_part(ContactMemory &memory, const AskingSpring &spring,
                   const double dt);

/** What the force of a spring, in full, would take [J]: f . v dt, what it is
    worth in the next step, and what backs both. */
struct SpringClaim
{
  double work = 0., kick = 0., available = 0.;
};
/** The three steps of backed_part(), for springs that are backed together: the
    last force has acted; the part; this one acts. */
SpringClaim claim_of(ContactMemory &memory, const AskingSpring &spring,
                     const double dt);
double part_of(const SpringClaim &claim);
void give(ContactMemory &memory, const AskingSpring &spring,
          const SpringClaim &claim, const double part);

/**
 * Friction on a node: a spring along the surface that gives way at the
 * @p largest force, Coulomb's of an elastic bond (Cundall and Strack 1979),
 *
 *     f' = f_old - k v_t dt - c v_t,   f = f' min(1, largest/|f'|).
 *
 * where what has just met starts with f_old = -k d v_t/|v|, as if it had come
 * in along its velocity. What slides has all of the friction, whatever the
 * step, and what sticks does not creep, for its spring bears a load without
 * moving. A bound by what stops the node within the step has neither: the mass
 * of a node that bears its body's pressure is worth less than the friction on
 * it. Before backed_part(), which tells it whether both have just met.
 * @param normal: unit, of the surface; the force of the last step turns with
 *   it. @p velocity: of the node against what it touches [m/s]; @p depth [m],
 *   @p k [N/m], @p c [N s/m], @p dt [s].
 */
inline Vec spring_friction(ContactMemory &memory, const Vec normal,
                           const Vec velocity, const double depth,
                           const double k, const double c, const double largest,
                           const double dt)
{
  const Vec v = velocity - dot(velocity, normal) * normal;
  Vec old = memory.friction - dot(memory.friction, normal) * normal;
  const double before = norm(memory.friction), after = norm(old);
  if (after > 0.)
    old *= before / after;
  const double speed = norm(velocity);
  if (norm_square(memory.spring) == 0. && speed > 0.)
    old = (-k * depth / speed) * v;
  const auto held = [largest](const Vec f)
  {
    const double size = norm(f);
    return size > largest ? (largest / size) * f : f;
  };
  const Vec spring = old - (k * dt) * v;
  memory.friction = held(spring);
  return held(spring - c * v);
}
} // namespace sabot

#endif
