#ifndef sabot_simulation_step_shares_h
#define sabot_simulation_step_shares_h

#include "sabot/base/message_count.h"
#include "sabot/base/state_visitor.h"
#include "sabot/integrator/stepper.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sabot
{
/**
 * How many steps a run needed, and what made them short. The measure is the
 * step that the undeformed particles can make by themselves at rest, dt_0, or,
 * of a scene that starts without any, the cells: a run over the time t in n
 * steps took
 *
 *   n dt_0/t
 *
 * times as many steps as these need. With nothing else in the way this is one
 * over the step factor; the rest is what deformation, contact, finer bodies and
 * viscosity cost. The same on all ranks.
 */
class StepShares
{
public:
  /** Keeps references to bodies and couplings. */
  StepShares(const std::vector<std::unique_ptr<Body>> &bodies,
             const std::vector<std::unique_ptr<Coupling>> &couplings,
             const StepLimits &limits);

  /** Of each body [s], Stepper::own_steps(). */
  void start(const std::vector<double> &own_steps);
  /** A step of @p dt [s] is made on @p proposal; @p is_last: to the end
      time. */
  void look(const StepProposal &proposal, const double dt, const bool is_last);

  /** dt_0 [s]; 0 where nothing has a step of its own, as in a scene of rigid
      bodies. */
  double own_step() const { return step_at_rest; }
  /** Whose it is: "particles" or "cells". */
  std::string own_step_of() const { return item_at_rest; }
  /** n dt_0/t; 0 where no time has passed or there is no dt_0. */
  double ratio(const unsigned int n, const double time) const;

  /** What limited steps, and how many. */
  struct Row
  {
    std::string name, kind; // of a body: "particles", "cells", "mass scaling"
    std::int64_t steps;
  };
  /** Most steps first; what limited none is left out. */
  std::vector<Row> rows() const;
  std::int64_t all_steps() const;

  void visit_state(StateVisitor &visitor)
  {
    visitor.visit_array("limited steps", counts);
  }

private:
  const std::vector<std::unique_ptr<Body>> &bodies;
  const std::vector<std::unique_ptr<Coupling>> &couplings;
  const StepLimits limits;
  double step_at_rest = 0.;
  std::string item_at_rest;
  /** Of each body by itself and held by mass scaling, of each coupling, of
      growth, of the largest step, of the end time. */
  std::vector<std::int64_t> counts;
};

/** What a rank told others in the steps that this process made, without output,
    balance and checkpoints. */
struct StepMessages
{
  MessageCount sum;
  unsigned int steps = 0;
};

/** Means over ranks and steps, largest mean of a rank. */
struct MessageRates
{
  std::string name;
  double mean, largest;
};
/** One per kind of MessageCount; zero without steps. Collective. */
std::vector<MessageRates> message_rates(const StepMessages &messages,
                                        MPI_Comm communicator);

/** For the log: "1.42 times as many steps as ...; limited by ...". Empty
    without steps or a step of its own. */
std::string describe_steps(const StepShares &shares, const unsigned int n,
                           const double time);
/** For the log of several ranks. */
std::string describe_messages(const std::vector<MessageRates> &rates);
} // namespace sabot

#endif
