#ifndef sabot_integrator_central_difference_h
#define sabot_integrator_central_difference_h

#include "sabot/base/timers.h"
#include "sabot/bodies/body.h"
#include "sabot/couplings/coupling.h"
#include "sabot/integrator/substeps.h"
#include "sabot/loads/load.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/**
 * The step a scene can make next, the same on every rank.
 * Least over bodies and couplings of their own estimates, 2/omega_max or h/c.
 * Of equal ones the lowest body, then the lowest item is named, so that the log
 * does not depend on the ranks.
 */
struct StepProposal
{
  double dt;           // [s], before the step factor
  std::string limiter; // body or coupling and item
  bool interrupted;    // some rank was asked to stop
  int source = -1;     // of bodies, then of couplings; -1: nothing limits it
  /** Stable step of each body by itself, and the least that couplings ask for
      [s]. */
  std::vector<double> body_steps = {};
  double coupling_step = 0.;
};

/**
 * Central difference (Newmark beta = 0, gamma = 1/2; Wu & Wu 2018, Eq. 10) with
 * variable step in kick-drift-kick form: v(n+1/2) = v(n) + dt/2 a(n),
 * x(n+1) = x(n) + dt v(n+1/2), v(n+1) = v(n+1/2) + dt/2 a(n+1).
 * Of second order in dt and symplectic for constant steps; explicit, stable
 * without damping for dt < 2/omega_max. Velocities that are imposed, by
 * boundary conditions and ties, are set after each kick, so that positions
 * follow from them. Masses are lumped: a = force/inertia, and nodes with
 * inertia 0 follow a tie.
 */
class CentralDifference
{
public:
  /**
   * All are kept by reference; bodies must have been distributed before
   * initialize().
   */
  CentralDifference(std::vector<std::unique_ptr<Body>> &bodies,
                    std::vector<std::unique_ptr<Load>> &loads,
                    std::vector<std::unique_ptr<Coupling>> &couplings,
                    Timers &timers, MPI_Comm communicator);

  /**
   * Initial velocities and forces. Collective.
   * Imposes velocities at the present time and computes forces with dt = 0.
   * @p most_substeps: that a body may make within one of the scene's.
   */
  void initialize(const unsigned int most_substeps);
  /**
   * Advance by @p dt. Collective. Throws PhysicsError on all ranks when a body
   * went wrong on any.
   * In this order: half kick, imposed velocities, work of the half step with
   * the old forces, drift, forces at t + dt (ghosts exchanged first), work of
   * the half step with the new forces, half kick, imposed velocities. Each
   * half's work is taken with v(n+1/2), so that
   *   W = dt/2 v(n+1/2) . (f(n) + f(n+1))
   * differs from the change of kinetic energy by dt^2/(8 m) (|f(n+1)|^2 -
   * |f(n)|^2), which is of second order and does not add up. @p dt > 0 [s].
   * @p counts: steps that each body makes meanwhile, see Substeps; empty: one.
   */
  void advance(const double dt, const std::vector<unsigned int> &counts);
  /** Before a step that is cut to meet the end: Coupling::keep_stiffness(). The
      last one may have been made before a restart. */
  void keep_stiffness(const double last_step);
  /**
   * Kernel updates and the like, after @p step steps. Collective.
   * Where a body says that something changed couplings pass on what is there
   * now, as ties do with forces: the next half kick feels what is there now.
   */
  void update_topology(const unsigned int step);
  /**
   * Least stable step over bodies, couplings and ranks. Collective.
   * One minimum over ranks for step and interruption, one for who limits it.
   */
  StepProposal propose(const bool interrupted) const;
  /** The least of the scene where bodies have these stable steps and couplings
      ask for @p couplings [s]; what propose() makes of those of now. */
  double step_of(const std::vector<double> &bodies_own,
                 const double couplings_least) const;

  /** Of the state [s], that of positions; grows by dt in advance(). */
  double time = 0.;
  Substeps substeps;
  /** Stable step of each body when initialize() found it, before inertia was
      added [s]; the largest double where it bounds nothing. */
  std::vector<double> own_steps;

private:
  double last_step = 0.; // [s]
  /** Inertia of bodies that hold a smallest step; couplings pass it on. @p
      changed: whether they have forces to pass on, anyway. */
  void hold_steps(const unsigned int step, bool changed);
  /** Cells or particles of @p body over the number of ranks. */
  double items_of_rank(const Body &body) const;
  /** v += dt force/inertia of owned nodes. */
  void kick(const double dt);
  static void kick(NodalState &nodes, const double dt);
  /** x += dt v of owned nodes. */
  static void drift(NodalState &nodes, const double dt);
  /** Bodies at the present time, loads for the stretch of time from there to
      @p end, then couplings. */
  void impose_velocities(const double end);
  /** Of what acts from outside and in couplings, over @p half_dt [s]. */
  void accumulate_work(const double half_dt);
  /**
   * Of bodies first, whose problems all ranks agree on, then of loads, then of
   * couplings, each with its search before.
   */
  void compute_forces(const double dt);
  /** Ghosts, then the body's own forces at time @p at [s]. Collective. Keeps
      the first @p problem. */
  void compute_own_forces(Body &body, const double at, const double dt,
                          std::string &problem);
  /** From the position after the first drift on to the end of a step of @p dt.
      Collective. */
  void make_substeps(Substeps::Member &member, const double dt,
                     std::string &problem);
  /** Body and item, or coupling, whose stable step is @p dt; @p decides: the
      body, or the number of bodies for a coupling. Collective. */
  void name_limiter(const double dt, const std::size_t decides,
                    StepProposal &proposal) const;
  /**
   * Throws PhysicsError with the message of the lowest rank that has one; an
   * empty @p problem is none. Collective.
   */
  void agree_on_problems(const std::string &problem) const;

  std::vector<std::unique_ptr<Body>> &bodies;
  std::vector<std::unique_ptr<Load>> &loads;
  std::vector<std::unique_ptr<Coupling>> &couplings;
  Timers &timers;
  MPI_Comm communicator;
};
} // namespace sabot

#endif
