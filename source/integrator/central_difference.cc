// Central differences: kicks, drifts, and the order in which bodies and
// couplings take part in a step.

#include "sabot/integrator/central_difference.h"

#include "sabot/base/error.h"

#include <algorithm>

namespace sabot
{
CentralDifference::CentralDifference(
    std::vector<std::unique_ptr<Body>> &bodies,
    std::vector<std::unique_ptr<Load>> &loads,
    std::vector<std::unique_ptr<Coupling>> &couplings, Timers &timers,
    MPI_Comm communicator)
    : bodies(bodies), loads(loads), couplings(couplings), timers(timers),
      communicator(communicator)
{
}

void CentralDifference::initialize()
{
  impose_velocities(time);
  compute_forces(no_step);
  hold_steps(0, false);
}

void CentralDifference::kick(const double dt)
{
  const auto timer = timers.scope("integrate");
  for (auto &body : bodies)
  {
    NodalState &nodes = body->nodes();
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      if (!nodes.is_follower(i))
        nodes.velocity[i] += (dt / nodes.inertia[i]) * nodes.force[i];
  }
}

void CentralDifference::impose_velocities(const double end)
{
  for (auto &body : bodies)
    body->impose_velocities(time);
  for (auto &load : loads)
    load->impose_velocities(time, end);
  const auto timer = timers.scope("tie");
  for (auto &coupling : couplings)
    coupling->impose_kinematics();
}

void CentralDifference::accumulate_work(const double half_dt)
{
  for (auto &body : bodies)
    body->accumulate_work(half_dt);
  for (auto &load : loads)
    load->accumulate_work(half_dt);
  for (auto &coupling : couplings)
    coupling->accumulate_work(half_dt);
}

void CentralDifference::advance(const double dt)
{
  kick(0.5 * dt); // v(n+1/2)
  impose_velocities(time + dt);
  {
    const auto timer = timers.scope("coupling work");
    accumulate_work(0.5 * dt);
  }
  {
    const auto timer = timers.scope("integrate");
    for (auto &body : bodies) // x(n+1)
    {
      NodalState &nodes = body->nodes();
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
        nodes.position[i] += dt * nodes.velocity[i];
    }
  }
  time += dt;
  last_step = dt;
  compute_forces(dt);
  {
    const auto timer = timers.scope("coupling work");
    accumulate_work(0.5 * dt);
  }
  kick(0.5 * dt); // v(n+1)
  impose_velocities(time);
}

void CentralDifference::compute_forces(const double dt)
{
  std::string problem;
  for (auto &body : bodies)
  {
    {
      const auto timer = timers.scope("ghost exchange");
      body->update_ghosts();
    }
    const auto timer = timers.scope(body->step_timer_name());
    try
    {
      body->compute_forces(time, dt);
    }
    catch (const PhysicsError &e)
    {
      problem = e.what();
    }
  }
  agree_on_problems(problem);
  for (auto &load : loads)
    load->add_forces(time);
  for (auto &coupling : couplings)
  {
    {
      const auto timer = timers.scope(coupling->kind() + " search");
      coupling->update_search(0, dt);
    }
    const auto timer = timers.scope(coupling->kind());
    coupling->add_forces(dt);
  }
}

void CentralDifference::update_topology(const unsigned int step)
{
  const auto timer = timers.scope("kernel update");
  bool changed = false;
  for (auto &body : bodies)
    changed |= body->update_topology(step, time);
  for (auto &coupling : couplings)
    changed |= coupling->change_bodies(step);
  hold_steps(step, changed);
}

void CentralDifference::hold_steps(const unsigned int step, bool changed)
{
  for (auto &body : bodies)
    changed |= body->hold_step(step, last_step);
  // The half step that starts now feels what there is now.
  if (changed)
    for (auto &coupling : couplings)
      coupling->forward_changes();
}

void CentralDifference::agree_on_problems(const std::string &problem) const
{
  int rank, n_ranks;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  int first = problem.empty() ? n_ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, communicator);
  if (first == n_ranks)
    return;
  int length = problem.size();
  MPI_Bcast(&length, 1, MPI_INT, first, communicator);
  std::string message = problem;
  message.resize(length);
  MPI_Bcast(&message[0], length, MPI_CHAR, first, communicator);
  throw PhysicsError(message);
}

StepProposal CentralDifference::propose(const bool interrupted) const
{
  struct Proposal
  {
    double dt;
    GlobalIndex item;
    int source;
  } best{std::numeric_limits<double>::max(), -1, 0};
  int source = 0;
  const auto consider = [&](const StableStep &step)
  {
    if (step.dt < best.dt)
      best = {step.dt, step.item, source};
    ++source;
  };
  for (const auto &body : bodies)
    consider(body->stable_step());
  for (const auto &coupling : couplings)
    consider(coupling->stable_step());

  double values[2] = {best.dt, interrupted ? -1. : 0.};
  MPI_Allreduce(MPI_IN_PLACE, values, 2, MPI_DOUBLE, MPI_MIN, communicator);
  // Of equal proposals the lowest body and item is named, whatever the ranks.
  constexpr GlobalIndex factor = GlobalIndex(1) << 48;
  GlobalIndex who = best.dt == values[0]
                        ? best.source * factor + best.item
                        : std::numeric_limits<GlobalIndex>::max();
  MPI_Allreduce(MPI_IN_PLACE, &who, 1, MPI_INT64_T, MPI_MIN, communicator);
  const std::size_t index = who / factor;
  StepProposal proposal{values[0], "", values[1] < 0.};
  if (index < bodies.size())
    proposal.limiter =
        bodies[index]->name + " #" + std::to_string(who % factor);
  else if (index - bodies.size() < couplings.size())
    proposal.limiter = couplings[index - bodies.size()]->name;
  return proposal;
}
} // namespace sabot
