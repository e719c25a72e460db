#ifndef sabot_integrator_substeps_h
#define sabot_integrator_substeps_h

#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"
#include "sabot/couplings/coupling.h"
#include "sabot/loads/load.h"

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Bodies that make several steps within one of the scene, so that those whose
 * cells are small or squeezed do not rule the steps of all others (subcycling).
 *
 * By impulses (Grubmueller, Heller, Windemuth & Schulten 1991, doi
 * 10.1080/08927029108022142; Tuckerman, Berne & Martyna 1992, doi
 * 10.1063/1.463137): over a step dt of the scene a body's own force f acts at
 * the ends of each of its n steps dt/n, what couplings and loads add, c, at the
 * ends of dt only,
 *
 *   kick at the ends    m dv = dt/2 (c + f/n),
 *   kicks in between    m dv = dt/n f.
 *
 * So action and reaction between bodies are equal at every moment, linear
 * momentum is kept to round-off whatever the numbers of steps, and n = 1 is the
 * central difference bit by bit. Contact springs follow the scene's step
 * (SpringOptions): their frequency times dt is below sqrt(phi), far from what
 * the impulses' resonance, at half a period of the body's own modes, could feed
 * against bulk viscosity and hourglass control (doc/theory/substeps.md).
 *
 * Of bodies that move node by node. Not of those whose nodes ties or
 * conversions move together with others', nor of those a load drives.
 */
class Substeps
{
public:
  struct Member
  {
    Body *body;
    unsigned int n = 1;     // within the present or the last step
    AlignedVector<Vec> own; // own part of the force on owned nodes [N]
    std::uint64_t made = 0; // so far

    /** The least whole number of steps, at least @p shares: of its own longest
        ones that make the scene's. It falls where it is safely too large only:
        each change shakes what rests on the body by half a kick of the contact
        forces. */
    unsigned int next(const double shares) const;
  };

  /** Those of @p bodies that may; none where @p most, the largest number of
      steps within one, is 1. After they were distributed. */
  void find(const std::vector<std::unique_ptr<Body>> &bodies,
            const std::vector<std::unique_ptr<Load>> &loads,
            const std::vector<std::unique_ptr<Coupling>> &couplings,
            const unsigned int most);
  /** Null for a body that may not. */
  Member *of(const Body &body);
  /** Null where body number @p b may not. */
  const Member *of(const std::size_t b) const;
  /** The scene's step and the body that decides on it, of the stable steps
      [s] of @p bodies: the least of all, members times the largest number of
      steps, and no longer than the longest of a body that deforms. */
  void bound(const std::vector<std::unique_ptr<Body>> &bodies,
             const std::vector<double> &own, double &step,
             std::size_t &decides) const;

  /** Body b makes @p counts [b] steps in the next one, or one each where that
      is empty: what kicks have of the forces. */
  void take(const std::vector<unsigned int> &counts);
  /** It starts. */
  void begin(const std::vector<unsigned int> &counts);
  /** Its own force has been found: keep it, and leave the part of it by which
      the step's end kicks, before loads and couplings add theirs. */
  static void keep_own(Member &member);
  /** They have: the force is the whole one again. */
  void complete();

  /** Around updates that change own parts of forces. Copies them. */
  void before_update();
  void after_update();

  /** Of members, how many steps they make and their own forces. After that of
      the bodies. */
  void visit_state(StateVisitor &visitor);

private:
  /** kick_change of its body [N]. */
  static void change_kick(Member &member);

  std::vector<Member> members; // ascending by body
  std::vector<AlignedVector<Vec>> before;
  unsigned int most = 1;
};
} // namespace sabot

#endif
