// Tied nodes: which face or cell each follower belongs to, its motion, and how
// its mass and force go to the leaders.

#include "sabot/couplings/tie.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sabot
{
namespace
{
struct FaceRecord
{
  GlobalIndex id;
  std::array<GlobalIndex, 4> node;
  std::array<Vec, 4> x;
  bool has_cell;                        // it is known what is behind
  std::array<GlobalIndex, 8> cell_node; // VTK order
  std::array<Vec, 8> cell_x;
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

/** Trilinear functions, and what they make of the corners. */
void trilinear(const std::array<double, 3> &xi, const std::array<Vec, 8> &x,
               std::array<double, 8> &w, Vec &point, Mat &slope)
{
  constexpr int sign[3][8] = {{-1, 1, 1, -1, -1, 1, 1, -1},
                              {-1, -1, 1, 1, -1, -1, 1, 1},
                              {-1, -1, -1, -1, 1, 1, 1, 1}};
  point = Vec{};
  slope = Mat::zero(); // column d in row d: dx/dxi_d
  for (int a = 0; a < 8; ++a)
  {
    double f[3];
    for (int d = 0; d < 3; ++d)
      f[d] = 0.5 * (1. + sign[d][a] * xi[d]);
    w[a] = f[0] * f[1] * f[2];
    point += w[a] * x[a];
    for (int d = 0; d < 3; ++d)
      slope.row[d] += 0.5 * sign[d][a] * f[(d + 1) % 3] * f[(d + 2) % 3] * x[a];
  }
}

/** Weights of a cell's corners with sum w_a x_a = @p x, by Newton's method;
    false where that is too far outside, or cannot be. */
bool continue_cell(const std::array<Vec, 8> &corners, const Vec x,
                   std::array<double, 8> &w)
{
  // A quarter of the cell: inner corners then have -1/4 of the mass at most.
  constexpr double farthest = 1.5, converged = 1e-14;
  std::array<double, 3> xi{};
  for (int iteration = 0; iteration < 50; ++iteration)
  {
    Vec point;
    Mat slope;
    trilinear(xi, corners, w, point, slope);
    double determinant;
    const Vec step = transpose(inverse(slope, determinant)) * (x - point);
    double change = 0.;
    for (int d = 0; d < 3; ++d)
    {
      xi[d] += step[d];
      change += std::abs(step[d]);
    }
    if (!(change < 10.))
      return false;
    if (change > converged && iteration < 49)
      continue;
    trilinear(xi, corners, w, point, slope);
    for (const double c : xi)
      if (std::abs(c) > farthest)
        return false;
    return change <= 1e-12;
  }
  return false;
}
} // namespace

Tie::Tie(const std::string &name, const std::vector<Body *> &bodies,
         const int follower, const int leader, const double tolerance,
         MPI_Comm communicator)
    : Coupling(name), bodies(bodies), follower(follower), leader(leader),
      tolerance(tolerance), communicator(communicator)
{
}

void Tie::use_face(Constraint &constraint)
{
  constraint.leader.fill(constraint.face[0]);
  constraint.weight.fill(0.);
  std::copy(constraint.face.begin(), constraint.face.end(),
            constraint.leader.begin());
  std::copy(constraint.face_weight.begin(), constraint.face_weight.end(),
            constraint.weight.begin());
}

std::pair<double, double>
Tie::judge(const std::vector<Constraint> &constraints) const
{
  // With n_f = sum |w_f|, |sum w_f u|^2 <= n_f sum |w_f| u^2, so that
  // K <= omega^2 (m_a + sum n_f |w_fa| m_f) against the mass m_a + sum w_fa
  // m_f.
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::map<GlobalIndex, std::pair<double, double>> added;
  for (const Constraint &c : constraints)
  {
    double n = 0.;
    for (const double w : c.weight)
      n += std::abs(w);
    for (int a = 0; a < 8; ++a)
      if (bodies[leader]->node_owner[c.leader[a]] == rank)
      {
        added[c.leader[a]].first += c.weight[a] * c.mass;
        added[c.leader[a]].second += n * std::abs(c.weight[a]) * c.mass;
      }
  }
  const NodalState &leads = bodies[leader]->nodes();
  double least[2] = {1., 1.};
  for (std::size_t i = 0; i < leads.n_owned; ++i)
  {
    const auto found = added.find(leads.global_id[i]);
    if (found == added.end())
      continue;
    const double m = leads.lumped_mass[i], mass = m + found->second.first;
    least[0] = std::min(least[0], mass / m);
    least[1] = std::min(least[1], mass / (m + found->second.second));
  }
  MPI_Allreduce(MPI_IN_PLACE, least, 2, MPI_DOUBLE, MPI_MIN, communicator);
  return {least[0], least[1]};
}

std::vector<Tie::Constraint> Tie::find_constraints() const
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  Body &leading = *bodies[leader];
  const ContactSurface surface = leading.contact_surface();
  const NodalState &nodes = leading.nodes();
  const std::vector<std::array<std::size_t, 8>> behind =
      leading.faces()->cells_behind_faces();
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
                                             record.node.end())] != rank)
      continue;
    record.has_cell =
        f < behind.size() &&
        std::all_of(surface.faces[f].begin(), surface.faces[f].end(),
                    [&](const std::size_t a)
                    {
                      return std::find(behind[f].begin(), behind[f].end(), a) !=
                             behind[f].end();
                    });
    for (int a = 0; a < 8 && record.has_cell; ++a)
    {
      record.cell_node[a] = nodes.global_id[behind[f][a]];
      record.cell_x[a] = nodes.reference_position[behind[f][a]];
    }
    my_faces.push_back(record);
  }
  std::vector<FaceRecord> faces = gather_all(my_faces, communicator);
  std::sort(faces.begin(), faces.end(),
            [](const FaceRecord &a, const FaceRecord &b)
            { return a.id < b.id; });

  const NodalState &followers = bodies[follower]->nodes();
  const ContactSurface open = bodies[follower]->contact_surface();
  const double reach = tolerance * open.spacing, touching = 1e-9 * open.spacing;
  std::vector<Constraint> mine;
  for (std::size_t i = 0; i < followers.n_owned; ++i)
  {
    const Vec x = followers.reference_position[i];
    double best = reach;
    Constraint constraint{};
    const FaceRecord *on = nullptr;
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
      if (distance < best - (on ? touching : 0.))
      {
        best = distance;
        on = &face;
        constraint.face_weight = weight;
      }
    }
    if (!on)
      continue;
    constraint.follower = followers.global_id[i];
    constraint.mass = followers.lumped_mass[i];
    constraint.face = on->node;
    constraint.leader = on->cell_node;
    if (best <= touching || !on->has_cell ||
        !continue_cell(on->cell_x, x, constraint.weight))
      use_face(constraint);
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
  std::vector<Constraint> constraints = find_constraints();
  n_constraints = constraints.size();
  if (n_constraints == 0)
    throw InputError("Couplings/" + name,
                     "no node of body \"" + bodies[follower]->name +
                         "\" lies on the surface of body \"" +
                         bodies[leader]->name +
                         "\": check zone, sizes and positions");

  const bool has_negative = std::any_of(
      constraints.begin(), constraints.end(),
      [](const Constraint &c)
      { return *std::min_element(c.weight.begin(), c.weight.end()) < 0.; });
  if (has_negative)
  {
    // Where coarse particles would take more than half of a fine cell's mass,
    // all stay on the faces.
    constexpr double least_mass = 0.5;
    const auto [mass, step_square] = judge(constraints);
    if (mass >= least_mass)
      step_factor = std::sqrt(step_square);
    else
      std::for_each(constraints.begin(), constraints.end(), use_face);
  }

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
      for (int a = 0; a < 8; ++a)
        if (c.weight[a] != 0.)
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

void Tie::forward_changes()
{
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

Measures Tie::measure() const
{
  return {{"tied nodes", "1", double(n_constraints)}};
}
} // namespace sabot
