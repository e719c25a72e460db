#ifndef sabot_couplings_closing_limit_h
#define sabot_couplings_closing_limit_h

#include "sabot/couplings/symmetry_walls.h"

#include <memory>

namespace sabot
{
/**
 * Bounds the step by what two bodies that meet close in within it, translation
 * and spin: a spring of contact that is bounded by mass over step squared lets
 * bodies in by some of these distances, and a step that is longer than a body
 * is thick would take one through the other. With the speed v of closing, the
 * spacing h of the finer surface, and the time t at which the boxes around the
 * two can meet at the earliest,
 *
 *   dt <= c h/v + t/2,   c = 0.01 where neither deforms, else 0.03.
 *
 * Rigid bodies have no wave speed to bound the step. Their nodes are light
 * beside them, and so is the bound of the spring: a block of n cells along its
 * flight goes in by about sqrt(10 n) of the distances. Between bodies that
 * deform, 0.03 lets the spring have the stiffness of the metal, K h, when they
 * first meet at 1 km/s; later crushed cells make the step shorter anyway.
 *
 * v is that of boxes around the velocities: of a rigid body's nodes, and of the
 * center of mass of one that deforms, whose parts do not matter here. Of rigid
 * bodies that touch it is the largest so far, forgotten by 0.0005 a step: a
 * step that grew while they stand still between coming and going would soften
 * the spring that holds their energy.
 */
class ClosingLimit : public Coupling
{
public:
  /** Of all pairs that the @p couplings hold apart, and of rigid bodies and
      planes of symmetry. @p bodies by number. Before they are distributed. */
  ClosingLimit(const std::vector<Body *> &bodies,
               const std::vector<std::unique_ptr<Coupling>> &couplings,
               MPI_Comm communicator);
  bool any() const { return !pairs.empty(); }

  std::string kind() const override { return "step limit"; }
  void initialize() override;
  /** No forces: where all have moved, looks at boxes. Collective. */
  void add_forces(const double dt) override;
  StableStep stable_step() const override { return limit; }
  /** "closing per step over spacing max": of bodies whose boxes met. */
  Measures measure() const override;
  void visit_state(StateVisitor &visitor) override;

private:
  /** Bounds of places [m] and velocities [m/s]; of a body or a plane. */
  struct Motion
  {
    Vec low, high, slowest, fastest;
  };
  struct Pair
  {
    int a, b;        // of motions
    bool both_rigid; // or rigid and a plane
    double part, spacing;
    double stability_fraction; // of the springs between two bodies
    double reference = 0.;     // speed [m/s]
  };
  /** Of rigid bodies always, of others every tenth time. */
  void find_motions();
  void bound_step(Pair &pair, const double dt);
  /** c of two rigid bodies: a single node that meets the other body has to
      stop all of it. With the spring phi m/dt^2 of the node it goes in by
      v dt sqrt(M/(phi m)), M the reduced mass of the bodies, which is to stay
      below a quarter of the spacing. Collective. */
  double part_of_pair(const Pair &pair) const;
  static double time_to_meet(const Motion &a, const Motion &b);

  const std::vector<Body *> bodies;
  MPI_Comm communicator;
  std::vector<char> is_used, is_rigid; // of each body
  std::vector<double> spacing;         // of each body [m]
  std::vector<Motion> motions;         // of bodies, then of planes
  std::vector<Pair> pairs;
  std::uint64_t n_looks = 0;
  StableStep limit;
  double largest = 0.; // closing per step over spacing
};
} // namespace sabot

#endif
