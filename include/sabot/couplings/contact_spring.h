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

  /** The node is outside: it may come in anew. The side stays known. */
  void release()
  {
    depth = offset = stored = 0.;
    spring = Vec{};
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

/**
 * Part of a spring's force, in [0, 1], that the work it has taken bears; keeps
 * the books in @p memory. Between crumbled or crumpled surfaces normals and
 * weights change with each other's disorder and k depth has no potential: a
 * spring may push its way apart further than it was pressed. It gives back what
 * it took, and what one step's motion is worth, k (|v| dt)^2/2.
 * @param spring: k depth n, on the node [N]; @p v: of the node against what it
 *   touches [m/s]; @p k: [N/m].
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
} // namespace sabot

#endif
