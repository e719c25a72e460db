#ifndef sabot_integrator_stepper_h
#define sabot_integrator_stepper_h

#include "sabot/base/state_visitor.h"
#include "sabot/integrator/central_difference.h"

#include <limits>

namespace sabot
{
/**
 * What bounds a step besides the stable step of bodies and couplings.
 * The defaults bound nothing but factor and growth.
 */
struct StepLimits
{
  double factor = 0.9; // of the least stable step
  double largest = std::numeric_limits<double>::max();  // [s]
  double end_time = std::numeric_limits<double>::max(); // [s], met exactly
  /** Step over the last one at most: contact penalties follow the step, so it
      may grow slowly only. */
  double growth = 1.05;
  /** That a body may make within one step of the scene. */
  unsigned int most_substeps = 1;
};

/**
 * The life of a time step, the same for runs, plans and verification problems:
 *
 *   const StepProposal proposal = stepper.propose(false);
 *   stepper.advance(stepper.choose(proposal));
 *   stepper.update();
 *
 * All but choose() are collective.
 */
class Stepper
{
public:
  /** References are kept; @p limits are copied. */
  Stepper(std::vector<std::unique_ptr<Body>> &bodies,
          std::vector<std::unique_ptr<Load>> &loads,
          std::vector<std::unique_ptr<Coupling>> &couplings,
          const StepLimits &limits, Timers &timers, MPI_Comm communicator)
      : limits(limits),
        integrator(bodies, loads, couplings, timers, communicator)
  {
  }

  /** Initial velocities and forces. */
  void initialize() { integrator.initialize(limits.most_substeps); }
  /**
   * The least stable step and who limits it. @p interrupted: whether this rank
   * was asked to stop.
   * Before factor and limits [s].
   */
  StepProposal propose(const bool interrupted) const
  {
    return integrator.propose(interrupted);
  }
  /** CentralDifference::step_of(): before factor and limits [s]. */
  double step_of(const std::vector<double> &bodies,
                 const double couplings) const
  {
    return integrator.step_of(bodies, couplings);
  }
  /**
   * The step to make now [s].
   *   dt = min(factor dt_stable, largest, growth dt_last),
   * growth from the second step on; where that reaches the end time to 1e-9,
   * just what is left to it. The same on all ranks, as the proposal is. A step
   * that is not positive is the caller's to refuse.
   */
  double choose(const StepProposal &proposal) const;
  /**
   * Advance by @p dt; throws PhysicsError on all ranks when a body went wrong
   * on any.
   * Any positive step may be given; it is the one that growth is measured by
   * next.
   */
  void advance(const double dt, const std::vector<unsigned int> &counts = {});
  /** Steps that each body makes within one of @p dt [s], none of them longer
      than the factor times the stable one. */
  std::vector<unsigned int> substeps(const StepProposal &proposal,
                                     const double dt) const;
  /** Kick by them from here on, as advance() will. */
  void take(const std::vector<unsigned int> &counts)
  {
    integrator.substeps.take(counts);
  }
  /** Steps of @p body so far over those of the scene. */
  double mean_substeps(const Body &body) const;
  /**
   * Kernel updates, failure, erosion: what is due between steps.
   * With the number of steps made, on which intervals of kernel updates and
   * searches depend.
   */
  void update() { integrator.update_topology(n_steps); }
  /** Time, number and size of steps. */
  void visit_state(StateVisitor &visitor);
  /** After the state of the bodies. */
  void visit_substeps(StateVisitor &visitor);

  double time() const { return integrator.time; } // [s]
  unsigned int steps() const { return n_steps; }  // made so far
  double last_step() const { return dt; }         // [s], 0 at the start
  /** Whether a step of @p next [s] is shorter than the last one, to meet the
      end time. */
  bool is_cut(const double next) const
  {
    return n_steps > 0 && next < dt && reaches_end(next);
  }
  /** To 1e-12 of the end time, as sums of steps are not exact. */
  bool is_finished() const { return time() >= limits.end_time * (1. - 1e-12); }

  /** Whether a step of @p dt [s] is the last one, which is cut to meet the end
      time. */
  bool reaches_end(const double dt) const
  {
    return time() + dt >= limits.end_time * (1. - 1e-12);
  }

  /** CentralDifference::own_steps. */
  const std::vector<double> &own_steps() const { return integrator.own_steps; }

  const StepLimits limits;

private:
  CentralDifference integrator;
  unsigned int n_steps = 0;
  double dt = 0.;
};
} // namespace sabot

#endif
