#ifndef sabot_integrator_central_difference_h
#define sabot_integrator_central_difference_h

#include "sabot/base/timers.h"
#include "sabot/bodies/body.h"
#include "sabot/couplings/coupling.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** The step a scene can make next, the same on every rank. */
struct StepProposal
{
  double dt;           // [s], before the step factor
  std::string limiter; // body or coupling and item
  bool interrupted;    // some rank was asked to stop
};

/**
 * Central difference (Newmark beta = 0, gamma = 1/2; Wu & Wu 2018, Eq. 10) with
 * variable step in kick-drift-kick form: v(n+1/2) = v(n) + dt/2 a(n),
 * x(n+1) = x(n) + dt v(n+1/2), v(n+1) = v(n+1/2) + dt/2 a(n+1).
 */
class CentralDifference
{
public:
  CentralDifference(std::vector<std::unique_ptr<Body>> &bodies,
                    std::vector<std::unique_ptr<Coupling>> &couplings,
                    Timers &timers, MPI_Comm communicator);

  /** Initial velocities and forces. Collective. */
  void initialize();
  /** Advance by @p dt. Collective. Throws PhysicsError on all ranks when a
      body went wrong on any. */
  void advance(const double dt);
  /** Kernel updates and the like, after @p step steps. Collective. */
  void update_topology(const unsigned int step);
  /** Least stable step over bodies, couplings and ranks. Collective. */
  StepProposal propose(const bool interrupted) const;

  double time = 0.;

private:
  void kick(const double dt);
  void impose_velocities();
  void accumulate_work(const double half_dt);
  void compute_forces(const double dt);
  void agree_on_problems(const std::string &problem) const;

  std::vector<std::unique_ptr<Body>> &bodies;
  std::vector<std::unique_ptr<Coupling>> &couplings;
  Timers &timers;
  MPI_Comm communicator;
};
} // namespace sabot

#endif
