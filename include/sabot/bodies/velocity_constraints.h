#ifndef sabot_bodies_velocity_constraints_h
#define sabot_bodies_velocity_constraints_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/resultant.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Velocity components of owned nodes that are held at constant values: clamped
 * nodes, symmetry planes (the normal component is zero), driven faces.
 *
 * The reaction on a component with constant velocity is minus the node's force
 * there, so what drives the nodes does the work -f . v dt on the body
 * (trapezoidal over the step, as the work of couplings). Its impulse is what
 * impose() gives a node, inertia times the change of the velocity.
 *
 * Used as prescribe() for each component, finish(), then impose() after every
 * kick. No function is collective; ghosts' velocities come from their owners.
 */
class VelocityConstraints
{
public:
  /** What holds a component. */
  enum class Holder : int
  {
    symmetry,
    drive,
    clamp
  };
  /** Hold component @p axis of node @p i; a later call replaces an earlier.
      i local and owned, axis 0 to 2, velocity [m/s]. FemBoundary relies on
      the order: planes of symmetry, driven faces, clamped ones. */
  void prescribe(const std::size_t i, const int axis, const double velocity,
                 const Holder by);
  /** Once, after the last prescribe(). Sorts by node, and finds out whether
      any velocity differs from zero: without, there is no work to be done. */
  /** Of bodies that grow: nodes may come that are held so; its forces are told
      from the start. */
  void expect(const Holder by) { is_expected[static_cast<int>(by)] = 1; }
  void finish();
  /** The same for nodes behind all that are held already, whose impulses
      stay. */
  void append();

  /** What is held of node @p i after finish(): 1 where a component is free,
      else 0, and the value where it is held [m/s]. Found by bisection. */
  std::pair<Vec, Vec> held_at(const std::size_t i) const;

  /** Set the held components of the velocity; the others stay. v := free * v
      + factor value by component, the same bits wherever the node is owned.
      @p factor: by which all values are multiplied now. The first call makes
      the start of the run: what it changes is no impulse. */
  void impose(NodalState &nodes, const double factor = 1.);
  /** Work along @p half_dt with the current forces; collective with nobody.
      -dt/2 f . v_prescribed [J]; tied followers, which have no inertia of
      their own, are moved by their leaders and do not count. */
  void accumulate_work(const NodalState &nodes, const double half_dt,
                       const double factor = 1.);
  /** Reactions on the nodes of body number @p body, one for each of @p kinds,
      which must be the same on every rank. Followers' velocities are their
      leaders'. Collective. */
  std::vector<Resultant> reactions(const NodalState &nodes, const int body,
                                   const std::vector<Holder> &kinds,
                                   MPI_Comm communicator) const;
  /** The same, of all kinds that there are on any rank. Collective. */
  std::vector<Resultant> reactions(const NodalState &nodes, const int body,
                                   MPI_Comm communicator) const;
  /** Impulses so far, on the @p nodes of @p body. */
  void visit_state(StateVisitor &visitor, const std::string &body,
                   const NodalState &nodes);
  /** Energy of half a kick by the present forces alone, of owned nodes and
      free components: sum of m |dt f/(2 m)|^2/2 [J], see
      Body::add_kick_energy(). */
  void add_kick_energy(const NodalState &nodes, const double dt,
                       ExactSum &sum) const;
  /** Work done on the owned nodes so far [J]. */
  const ExactSum &work() const { return done; }
  ExactSum &work() { return done; }

private:
  struct Held
  {
    std::size_t node;
    Vec free;  // 1 where the component is free, else 0
    Vec value; // [m/s], 0 where the component is free
    std::array<Holder, 3> by;
  };
  struct Component
  {
    bool is_held = false;
    double velocity = 0.;
    Holder by = Holder::clamp;
  };
  std::map<std::size_t, std::array<Component, 3>> collected;
  AlignedVector<Held> held;                  // ascending
  AlignedVector<Vec> impulse;                // of each of them [N s]
  std::array<int, 3> is_expected{{0, 0, 0}}; // by holder
  bool has_work = false, has_started = false;
  ExactSum done;
};
} // namespace sabot

#endif
