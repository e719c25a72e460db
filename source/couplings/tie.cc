#include "sabot/couplings/tie.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
struct FaceRecord
{
  GlobalIndex id;
  std::array<GlobalIndex, 4> node;
  std::array<Vec, 4> x;
};

struct NodeRecord
{
  GlobalIndex id;
  Vec x;
};

std::array<double, 4> bilinear(const double s, const double t)
{
  return {{0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t),
           0.25 * (1 + s) * (1 + t), 0.25 * (1 - s) * (1 + t)}};
}

/** Closest point of a bilinear quadrilateral by Gauss-Newton; returns the
    distance and the weights, or a huge distance when it lies outside. */
double project(const FaceRecord &face, const Vec x, std::array<double, 4> &w)
{
  double s = 0., t = 0.;
  for (int iteration = 0; iteration < 20; ++iteration)
  {
    w = bilinear(s, t);
    const Vec r = x - (w[0] * face.x[0] + w[1] * face.x[1] + w[2] * face.x[2] +
                       w[3] * face.x[3]);
    const Vec ds = 0.25 * ((1 - t) * (face.x[1] - face.x[0]) +
                           (1 + t) * (face.x[2] - face.x[3])),
              dt = 0.25 * ((1 - s) * (face.x[3] - face.x[0]) +
                           (1 + s) * (face.x[2] - face.x[1]));
    const double a = dot(ds, ds), b = dot(ds, dt), c = dot(dt, dt),
                 f = dot(ds, r), g = dot(dt, r), det = a * c - b * b;
    const double step_s = (c * f - b * g) / det, step_t = (a * g - b * f) / det;
    s += step_s;
    t += step_t;
    if (std::abs(step_s) + std::abs(step_t) < 1e-14)
      break;
  }
  constexpr double outside = 1e300, slack = 1e-6;
  if (!(std::abs(s) < 1 + slack && std::abs(t) < 1 + slack))
    return outside;
  w = bilinear(std::clamp(s, -1., 1.), std::clamp(t, -1., 1.));
  double sum = 0.;
  for (double &weight : w)
  {
    if (weight < 1e-9)
      weight = 0.;
    sum += weight;
  }
  Vec closest = {};
  for (int a = 0; a < 4; ++a)
  {
    w[a] /= sum;
    closest += w[a] * face.x[a];
  }
  return norm(x - closest);
}
} // namespace

Tie::Tie(const std::string &name, const std::vector<Body *> &bodies,
         const int follower, const int leader, const double tolerance,
         MPI_Comm communicator)
    : Coupling(name), bodies(bodies), follower(follower), leader(leader),
      tolerance(tolerance), communicator(communicator)
{
}

std::vector<Tie::Constraint> Tie::find_constraints() const
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  Body &leading = *bodies[leader];
  const ContactSurface surface = leading.contact_surface();
  const NodalState &nodes = leading.nodes();
  std::vector<FaceRecord> my_faces;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
  {
    FaceRecord record;
    record.id = surface.face_id[f];
    for (int a = 0; a < 4; ++a)
    {
      record.node[a] = nodes.global_id[surface.faces[f][a]];
      record.x[a] = nodes.reference_position[surface.faces[f][a]];
    }
    // A face is known to several ranks; one speaks for it.
    if (leading.node_owner[*std::min_element(record.node.begin(),
                                             record.node.end())] == rank)
      my_faces.push_back(record);
  }
  std::vector<FaceRecord> faces = gather_all(my_faces, communicator);
  std::sort(faces.begin(), faces.end(),
            [](const FaceRecord &a, const FaceRecord &b)
            { return a.id < b.id; });

  const NodalState &followers = bodies[follower]->nodes();
  const ContactSurface open = bodies[follower]->contact_surface();
  const double reach = tolerance * open.spacing;
  std::vector<Constraint> mine;
  for (std::size_t i = 0; i < followers.n_owned; ++i)
  {
    const Vec x = followers.reference_position[i];
    double best = reach;
    Constraint constraint;
    bool found = false;
    for (const FaceRecord &face : faces)
    {
      bool near = true;
      for (int d = 0; d < 3 && near; ++d)
      {
        double low = face.x[0][d], high = low;
        for (int a = 1; a < 4; ++a)
        {
          low = std::min(low, face.x[a][d]);
          high = std::max(high, face.x[a][d]);
        }
        near = x[d] > low - reach && x[d] < high + reach;
      }
      if (!near)
        continue;
      std::array<double, 4> weight;
      const double distance = project(face, x, weight);
      // The first of equally near faces wins, in global order.
      if (distance < best - (found ? 1e-9 * open.spacing : 0.))
      {
        best = distance;
        found = true;
        constraint = {followers.global_id[i], face.node, weight};
      }
    }
    if (found)
      mine.push_back(constraint);
  }
  std::vector<Constraint> all = gather_all(mine, communicator);
  std::sort(all.begin(), all.end(),
            [](const Constraint &a, const Constraint &b)
            { return a.follower < b.follower; });
  return all;
}

void Tie::initialize()
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const std::vector<Constraint> constraints = find_constraints();
  n_constraints = constraints.size();
  if (n_constraints == 0)
    throw InputError("Couplings/" + name,
                     "no node of body \"" + bodies[follower]->name +
                         "\" lies on the surface of body \"" +
                         bodies[leader]->name +
                         "\": check zone, sizes and positions");

  Body &following = *bodies[follower], &leading = *bodies[leader];
  NodalState &followers = following.nodes(), &leads = leading.nodes();
  const auto local = [](const NodalState &nodes, const GlobalIndex id)
  {
    return std::lower_bound(nodes.global_id.begin(),
                            nodes.global_id.begin() + nodes.n_owned, id) -
           nodes.global_id.begin();
  };

  // Motion: leaders of the followers that are owned here.
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
      const std::size_t i = local(followers, c.follower);
      owned_followers.push_back(i);
      for (int a = 0; a < 4; ++a)
        if (c.weight[a] > 0.)
          motion.push_back(
              {i, leaders.slot({leader, 0, c.leader[a]}), c.weight[a]});
    }

  // Forces: followers of the leaders that are owned here.
  std::vector<GlobalIndex> remote;
  std::vector<int> remote_owner;
  forces.clear();
  for (const Constraint &c : constraints)
  {
    const int owner = following.node_owner[c.follower];
    std::size_t slot = 0;
    bool has_slot = owner == rank;
    if (has_slot)
      slot = std::lower_bound(owned_followers.begin(), owned_followers.end(),
                              local(followers, c.follower)) -
             owned_followers.begin();
    for (int a = 0; a < 4; ++a)
      if (c.weight[a] > 0. && leading.node_owner[c.leader[a]] == rank)
      {
        if (!has_slot)
        {
          slot = owned_followers.size() + remote.size();
          has_slot = true;
          remote.push_back(c.follower);
          remote_owner.push_back(owner);
        }
        forces.push_back(
            {std::size_t(local(leads, c.leader[a])), slot, c.weight[a]});
      }
  }
  const auto find = [&](const GlobalIndex key)
  {
    return std::lower_bound(owned_followers.begin(), owned_followers.end(),
                            local(followers, key)) -
           owned_followers.begin();
  };
  force_exchange = GhostExchange(communicator, owned_followers.size(),
                                 remote_owner, remote, find);
  follower_force.resize(owned_followers.size() + remote.size());

  // Leaders carry their followers' mass from now on.
  std::vector<double> mass(follower_force.size());
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    mass[s] = followers.lumped_mass[owned_followers[s]];
  force_exchange.update(mass.data());
  for (const Term &term : forces)
    leads.inertia[term.local] += term.weight * mass[term.slot];
  for (const std::size_t i : owned_followers)
    followers.inertia[i] = 0.;
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

void Tie::add_forces(const double)
{
  const NodalState &followers = bodies[follower]->nodes();
  NodalState &leads = bodies[leader]->nodes();
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    follower_force[s] = followers.force[owned_followers[s]];
  force_exchange.update(follower_force.data());
  for (const Term &term : forces)
    leads.force[term.local] += term.weight * follower_force[term.slot];
}

void Tie::accumulate_work(const double half_dt)
{
  const NodalState &followers = bodies[follower]->nodes(),
                   &leads = bodies[leader]->nodes();
  for (std::size_t s = 0; s < owned_followers.size(); ++s)
    work.add(-half_dt *
             dot(follower_force[s], followers.velocity[owned_followers[s]]));
  for (const Term &term : forces)
    work.add(half_dt * term.weight *
             dot(follower_force[term.slot], leads.velocity[term.local]));
}

void Tie::add_energies(EnergyLedger &ledger) const
{
  ledger.tie.subtract(work);
}

void Tie::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("work", work);
  // Half of their work along the next step is still to be counted.
  visitor.visit_array("follower force", follower_force);
}

Measures Tie::measure() const
{
  return {{"tied nodes", "1", double(n_constraints)}};
}
} // namespace sabot
