// Central differences: kicks, drifts, and the order in which bodies and
// couplings take part in a step.

#include "sabot/integrator/central_difference.h"

#include "sabot/base/error.h"
#include "sabot/base/text_of_ranks.h"

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

double CentralDifference::items_of_rank(const Body &body) const
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  return double(body.n_items()) / n_ranks;
}

void CentralDifference::initialize(const unsigned int most_substeps)
{
  substeps.find(bodies, loads, couplings, most_substeps);
  impose_velocities(time);
  compute_forces(no_step);
  own_steps.clear();
  for (const auto &body : bodies)
    own_steps.push_back(body->stable_step().dt);
  MPI_Allreduce(MPI_IN_PLACE, own_steps.data(), own_steps.size(), MPI_DOUBLE,
                MPI_MIN, communicator);
  hold_steps(0, false);
}

void CentralDifference::kick(const double dt)
{
  const auto timer = timers.scope("integrate");
  for (auto &body : bodies)
  {
    timer.count(body->nodes().n_owned);
    if (body->nodes().kick_change.empty())
      kick(body->nodes(), dt);
    else
    {
      NodalState &nodes = body->nodes();
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
        nodes.velocity[i] += (dt / nodes.inertia[i]) * nodes.kick_force(i);
    }
  }
}

void CentralDifference::kick(NodalState &nodes, const double dt)
{
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (!nodes.is_follower(i))
      nodes.velocity[i] += (dt / nodes.inertia[i]) * nodes.force[i];
}

void CentralDifference::drift(NodalState &nodes, const double dt)
{
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    nodes.position[i] += dt * nodes.velocity[i];
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

void CentralDifference::keep_stiffness(const double last_step)
{
  for (auto &coupling : couplings)
    coupling->keep_stiffness(last_step);
}

void CentralDifference::advance(const double dt,
                                const std::vector<unsigned int> &counts)
{
  substeps.begin(counts);
  kick(0.5 * dt); // v(n+1/2)
  impose_velocities(time + dt);
  {
    const auto timer = timers.scope("coupling work");
    accumulate_work(0.5 * dt);
  }
  {
    const auto timer = timers.scope("integrate");
    for (auto &body : bodies) // x(n+1), or that of the first substep
    {
      const Substeps::Member *const member = substeps.of(*body);
      drift(body->nodes(), member == nullptr ? dt : dt / member->n);
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
    Substeps::Member *const member = substeps.of(*body);
    if (member != nullptr)
      make_substeps(*member, dt, problem);
    else
      compute_own_forces(*body, time, dt, problem);
  }
  agree_on_problems(problem);
  for (auto &load : loads)
    load->add_forces(time);
  for (auto &coupling : couplings)
  {
    {
      const auto timer = timers.scope(coupling->kind() + " search");
      coupling->update_search(0, dt);
      timer.count(coupling->n_items());
    }
    const auto timer = timers.scope(coupling->kind());
    timer.count(coupling->n_items());
    coupling->add_forces(dt);
  }
  substeps.complete();
}

void CentralDifference::compute_own_forces(Body &body, const double at,
                                           const double dt,
                                           std::string &problem)
{
  {
    const auto timer = timers.scope("ghost exchange");
    timer.count(body.nodes().size() - body.nodes().n_owned);
    body.update_ghosts();
  }
  const auto timer = timers.scope(body.step_timer_name());
  timer.count(items_of_rank(body));
  try
  {
    body.compute_forces(at, dt);
  }
  catch (const PhysicsError &e)
  {
    // The first; other ranks go on until all agree.
    if (problem.empty())
      problem = e.what();
  }
}

void CentralDifference::make_substeps(Substeps::Member &member, const double dt,
                                      std::string &problem)
{
  Body &body = *member.body;
  NodalState &nodes = body.nodes();
  const unsigned int n = is_step(dt) ? member.n : 1;
  const double own_dt = dt / n, start = time - dt;
  nodes.kick_change.clear(); // in between all of its own force acts
  nodes.first_velocity.clear();
  if (n > 1)
    nodes.first_velocity.assign(nodes.velocity.begin(),
                                nodes.velocity.begin() + nodes.n_owned);
  for (unsigned int s = 1; s < n; ++s)
  {
    const double at = start + s * own_dt;
    compute_own_forces(body, at, own_dt, problem);
    body.accumulate_work(0.5 * own_dt);
    const auto timer = timers.scope("integrate");
    kick(nodes, own_dt);
    body.impose_velocities(at);
    body.accumulate_work(0.5 * own_dt);
    drift(nodes, own_dt);
  }
  compute_own_forces(body, time, own_dt, problem);
  Substeps::keep_own(member);
}

void CentralDifference::update_topology(const unsigned int step)
{
  const auto timer = timers.scope("kernel update");
  bool changed = false;
  substeps.before_update();
  for (auto &body : bodies)
  {
    const bool has_changed = body->update_topology(step, time);
    if (has_changed && body->particles() != nullptr)
      timer.count(items_of_rank(*body)); // kernels found anew
    changed |= has_changed;
  }
  for (auto &coupling : couplings)
    changed |= coupling->change_bodies(step);
  substeps.after_update();
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
  const std::string message = text_of_first(problem, communicator);
  if (!message.empty())
    throw PhysicsError(message);
}

StepProposal CentralDifference::propose(const bool interrupted) const
{
  constexpr double none = std::numeric_limits<double>::max();
  const std::size_t n = bodies.size();
  // Bodies, the least of couplings, and whether to stop.
  std::vector<double> least(n + 2, none);
  for (std::size_t b = 0; b < n; ++b) // not a number proposes nothing
    least[b] = std::min(least[b], bodies[b]->stable_step().dt);
  for (const auto &coupling : couplings)
    least[n] = std::min(least[n], coupling->stable_step().dt);
  least[n + 1] = interrupted ? -1. : 0.;
  MPI_Allreduce(MPI_IN_PLACE, least.data(), least.size(), MPI_DOUBLE, MPI_MIN,
                communicator);
  StepProposal proposal{none, "", least[n + 1] < 0.};
  std::size_t decides = n;
  substeps.bound(bodies, least, proposal.dt, decides);
  if (least[n] < proposal.dt)
  {
    proposal.dt = least[n];
    decides = n;
  }
  proposal.body_steps.assign(least.begin(), least.begin() + n);
  proposal.coupling_step = least[n];
  name_limiter(least[decides], decides, proposal);
  return proposal;
}

double CentralDifference::step_of(const std::vector<double> &bodies_own,
                                  const double couplings_least) const
{
  double step = couplings_least;
  std::size_t decides = bodies.size();
  substeps.bound(bodies, bodies_own, step, decides);
  return step;
}

void CentralDifference::name_limiter(const double dt, const std::size_t decides,
                                     StepProposal &proposal) const
{
  // Of equal proposals the lowest item is named, whatever the ranks.
  constexpr GlobalIndex factor = GlobalIndex(1) << 48;
  GlobalIndex who = std::numeric_limits<GlobalIndex>::max();
  const auto consider = [&](const std::size_t source, const StableStep &step)
  {
    if (step.dt == dt && step.dt < std::numeric_limits<double>::max())
      who = std::min(who, GlobalIndex(source) * factor + step.item);
  };
  if (decides < bodies.size())
    consider(decides, bodies[decides]->stable_step());
  else
    for (std::size_t c = 0; c < couplings.size(); ++c)
      consider(bodies.size() + c, couplings[c]->stable_step());
  MPI_Allreduce(MPI_IN_PLACE, &who, 1, MPI_INT64_T, MPI_MIN, communicator);
  const std::size_t index = who / factor;
  if (index < bodies.size() + couplings.size())
    proposal.source = index;
  if (index < bodies.size())
    proposal.limiter =
        bodies[index]->name + " #" + std::to_string(who % factor);
  else if (index - bodies.size() < couplings.size())
    proposal.limiter = couplings[index - bodies.size()]->name;
}
} // namespace sabot
