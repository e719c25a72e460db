// Followers that move as weighted sums of leaders, from step to step.
#include "sabot/couplings/tie.h"

#include "sabot/base/added_mass.h"
#include "sabot/base/error.h"
#include "sabot/couplings/tie_conflicts.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Local number of a node that is owned here. */
std::size_t owned_number(const NodalState &nodes, const GlobalIndex id)
{
  return std::lower_bound(nodes.global_id.begin(),
                          nodes.global_id.begin() + nodes.n_owned, id) -
         nodes.global_id.begin();
}
} // namespace

Tie::Tie(const std::string &name, const std::vector<Body *> &bodies,
         const int follower, const int leader, const double tolerance,
         MPI_Comm communicator, const std::shared_ptr<TiedNodes> &others)
    : Coupling(name), bodies(bodies), follower(follower), leader(leader),
      tolerance(tolerance), communicator(communicator),
      others(others ? others : std::make_shared<TiedNodes>())
{
}

std::vector<int> Tie::joins() const
{
  return {follower, leader};
}

void Tie::initialize()
{
  std::vector<Constraint> constraints = find_constraints();
  const TieConflicts conflicts{name,   bodies,       follower,
                               leader, communicator, *others};
  left_out = conflicts.leave_to_others(constraints);
  n_constraints = constraints.size();
  if (n_constraints == 0)
    throw InputError("Couplings/" + name,
                     (left_out.empty()
                          ? "no node of body \"" + bodies[follower]->name +
                                "\" lies on the surface of body \"" +
                                bodies[leader]->name + "\""
                          : left_out + ": nothing is left to tie") +
                         ": check zone, sizes and positions");
  step_factor = keep_mass(constraints);
  conflicts.refuse_chains(constraints);
  conflicts.refuse_held(constraints);
  prepare_motion(constraints);
  prepare_forces(constraints);

  // Leaders carry their followers' mass from now on.
  NodalState &followers = bodies[follower]->nodes(),
             &leads = bodies[leader]->nodes();
  std::vector<double> mass(follower_force.size());
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    mass[s] = followers.lumped_mass[owned_followers[s]];
  force_exchange.update(mass.data());
  for (const Term &term : forces)
    leads.inertia[term.local] += term.weight * mass[term.slot];
  for (const std::size_t i : owned_followers)
    followers.make_follower(i);
  scales_masses = bodies[follower]->mass_scaling() != nullptr;
  if (scales_masses)
    handed_on.assign(owned_followers.size(), 0.);
}

void Tie::prepare_motion(const std::vector<Constraint> &constraints)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const Body &following = *bodies[follower];
  std::vector<NodeKey> needed;
  for (const Constraint &c : constraints)
    if (following.node_owner[c.follower] == rank)
      for (const GlobalIndex a : c.leader)
        needed.push_back({leader, 0, a});
  leaders.build(bodies, needed, communicator);
  motion.clear();
  owned_followers.clear();
  for (const Constraint &c : constraints)
    if (following.node_owner[c.follower] == rank)
    {
      const std::size_t i = owned_number(following.nodes(), c.follower);
      owned_followers.push_back(i);
      for (int a = 0; a < 8; ++a)
        if (c.weight[a] != 0.)
          motion.push_back(
              {i, leaders.slot({leader, 0, c.leader[a]}), c.weight[a]});
    }
}

void Tie::prepare_forces(const std::vector<Constraint> &constraints)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const Body &following = *bodies[follower], &leading = *bodies[leader];
  const auto slot_of_owned = [&](const GlobalIndex key)
  {
    return std::lower_bound(owned_followers.begin(), owned_followers.end(),
                            owned_number(following.nodes(), key)) -
           owned_followers.begin();
  };
  std::vector<GlobalIndex> &remote = remote_followers;
  remote.clear();
  std::vector<int> remote_owner;
  forces.clear();
  for (const Constraint &c : constraints)
  {
    const int owner = following.node_owner[c.follower];
    bool has_slot = owner == rank;
    std::size_t slot = has_slot ? slot_of_owned(c.follower) : 0;
    for (int a = 0; a < 8; ++a)
      if (c.weight[a] != 0. && leading.node_owner[c.leader[a]] == rank)
      {
        if (!has_slot)
        {
          slot = owned_followers.size() + remote.size();
          has_slot = true;
          remote.push_back(c.follower);
          remote_owner.push_back(owner);
        }
        forces.push_back(
            {owned_number(leading.nodes(), c.leader[a]), slot, c.weight[a]});
      }
  }
  force_exchange = GhostExchange(communicator, owned_followers.size(),
                                 remote_owner, remote, slot_of_owned);
  follower_force.resize(owned_followers.size() + remote.size());
  for (AlignedVector<Vec> *const of_owned :
       {&impulse, &start_velocity, &mid_velocity})
    of_owned->assign(owned_followers.size(), Vec{});
}

void Tie::impose_kinematics()
{
  leaders.update();
  NodalState &followers = bodies[follower]->nodes();
  for (const std::size_t i : owned_followers)
    followers.velocity[i] = Vec{};
  for (const Term &term : motion)
    followers.velocity[term.local] += term.weight * leaders.velocity[term.slot];
}

void Tie::add_forces(const double dt)
{
  const NodalState &followers = bodies[follower]->nodes();
  NodalState &leads = bodies[leader]->nodes();
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    follower_force[s] = followers.force[owned_followers[s]];
  force_exchange.update(follower_force.data());
  for (const Term &term : forces)
    leads.force[term.local] += term.weight * follower_force[term.slot];
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    mid_velocity[s] = followers.velocity[owned_followers[s]];
  last_step = is_step(dt) ? dt : 0.;
  if (last_step == 0.)
    start_velocity = mid_velocity;
}

void Tie::forward_changes()
{
  if (scales_masses)
    hand_on_added_mass();
  const NodalState &followers = bodies[follower]->nodes();
  NodalState &leads = bodies[leader]->nodes();
  AlignedVector<Vec> change(follower_force.size());
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    change[s] = followers.force[owned_followers[s]] - follower_force[s];
  force_exchange.update(change.data());
  for (std::size_t s = 0; s < change.size(); ++s)
    follower_force[s] += change[s];
  for (const Term &term : forces)
    leads.force[term.local] += term.weight * change[term.slot];
}

void Tie::hand_on_added_mass()
{
  const NodalState &followers = bodies[follower]->nodes();
  NodalState &leads = bodies[leader]->nodes();
  std::vector<double> more(follower_force.size());
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
  {
    const double now = followers.added_mass[owned_followers[s]];
    more[s] = now - handed_on[s];
    handed_on[s] = now;
  }
  force_exchange.update(more.data());
  const VelocityConstraints *const held = bodies[leader]->prescribed();
  int is_bad = 0;
  for (const Term &term : forces)
  {
    if (!(more[term.slot] > 0.))
      continue;
    is_bad |= term.weight < 0.;
    const double mass = term.weight * more[term.slot];
    added_energy.add(energy_of_added_mass(
        leads, term.local, held->held_at(term.local).first, mass, last_step));
    leads.inertia[term.local] += mass;
  }
  MPI_Allreduce(MPI_IN_PLACE, &is_bad, 1, MPI_INT, MPI_MAX, communicator);
  if (is_bad)
    throw PhysicsError("tie \"" + name +
                       "\": mass that \"Smallest step\" "
                       "adds to body \"" +
                       bodies[follower]->name +
                       "\" at a node off the faces of body \"" +
                       bodies[leader]->name +
                       "\" would make nodes of that lighter; make the meshes "
                       "meet, or set a smaller \"Smallest step\"");
}

void Tie::accumulate_work(const double half_dt)
{
  const NodalState &followers = bodies[follower]->nodes(),
                   &leads = bodies[leader]->nodes();
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
  {
    work.add(-half_dt *
             dot(follower_force[s], followers.velocity[owned_followers[s]]));
    impulse[s] += half_dt * follower_force[s];
  }
  for (const Term &term : forces)
    work.add(half_dt * term.weight *
             dot(follower_force[term.slot], leads.velocity[term.local]));
}

void Tie::add_energies(EnergyLedger &ledger) const
{
  ledger.tie.subtract(work);
  ledger.added_mass.add(added_energy);
}

void Tie::visit_state(StateVisitor &visitor)
{
  const std::vector<GlobalIndex> &ids = bodies[follower]->nodes().global_id;
  std::vector<GlobalIndex> keys;
  for (const std::size_t i : owned_followers)
    keys.push_back(ids[i]);
  keys.insert(keys.end(), remote_followers.begin(), remote_followers.end());
  const StateItems items = {visitor.section + "/followers", keys.data(),
                            owned_followers.size(), keys.size()};
  visitor.visit_keys(items);
  visitor.visit_sum("work", work);
  // Half of their work along the next step is still to be counted.
  visitor.visit_items("follower force", follower_force, items);
  visitor.visit_items("impulse", impulse, items);
  visitor.visit_items("added mass handed on", handed_on, items);
  visitor.visit_sum("energy of added mass", added_energy);
}

std::vector<Resultant> Tie::resultants() const
{
  const NodalState &followers = bodies[follower]->nodes();
  ExactVectorSum force, total;
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
  {
    const std::size_t i = owned_followers[s];
    const Vec v = followers.velocity[i];
    const double mass = followers.lumped_mass[i];
    total.add(mass * (v - start_velocity[s]) - impulse[s]);
    if (last_step > 0.) // the last half kick: a = 2 (v - v_mid)/dt
      force.add((2. * mass / last_step) * (v - mid_velocity[s]) -
                follower_force[s]);
  }
  ExactVectorSum::reduce({&force, &total}, communicator);
  Resultant on_follower{name, follower, force.value(), total.value(), false},
      on_leader{name, leader, {}, {}, false};
  for (int d = 0; d < 3; ++d)
  {
    on_leader.force[d] = -on_follower.force[d];
    on_leader.impulse[d] = -on_follower.impulse[d];
  }
  return {on_follower, on_leader};
}

StableStep Tie::stable_step() const
{
  if (step_factor == 1.)
    return {};
  StableStep step = bodies[leader]->stable_step();
  const StableStep other = bodies[follower]->stable_step();
  if (other.dt < step.dt)
    step = other;
  step.dt *= step_factor;
  return step;
}

std::vector<std::string> Tie::warnings() const
{
  return left_out.empty()
             ? std::vector<std::string>()
             : std::vector<std::string>{"tie \"" + name + "\": " + left_out};
}

Measures Tie::measure() const
{
  return {{"tied nodes", "1", double(n_constraints)}};
}
} // namespace sabot
