// Planes of symmetry hold what comes to them: it meets its mirror image.
#include "sabot/couplings/symmetry_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
/** Distances below this part of a body's extent are round-off of meshes. */
constexpr double round_off = 1e-9;

/** Bounds of a body along an axis, and the middle of its nodes. */
struct Extent
{
  double low = std::numeric_limits<double>::max(),
         high = std::numeric_limits<double>::lowest(), middle = 0.;
};

Extent extent(const Body &body, const int axis)
{
  Extent e;
  const auto &points = body.partition_points();
  for (const auto &x : points)
  {
    e.low = std::min(e.low, x[axis]);
    e.high = std::max(e.high, x[axis]);
    e.middle += x[axis] / points.size();
  }
  return e;
}

/** Where @p body is of particles that are yet to come: their host. */
const Body &whole_of(const Body &body, const std::vector<Body *> &bodies)
{
  for (const Body *host : bodies)
    if (host->own_particles == &body)
      return *host;
  return body;
}
} // namespace

std::vector<std::vector<SymmetryWall>>
find_symmetry_walls(const std::vector<Body *> &bodies)
{
  std::vector<std::vector<SymmetryWall>> walls(bodies.size());
  std::vector<SymmetryWall> all;
  for (const Body *body : bodies)
    for (const SymmetryPlane &plane : body->planes_of_symmetry())
    {
      const Extent e = extent(whole_of(*body, bodies), plane.axis);
      const double side = e.middle > plane.coordinate ? 1. : -1.,
                   tolerance = round_off * (e.high - e.low);
      if (std::none_of(all.begin(), all.end(),
                       [&](const SymmetryWall &other)
                       {
                         return other.plane.axis == plane.axis &&
                                other.side == side &&
                                std::abs(other.plane.coordinate -
                                         plane.coordinate) <= tolerance;
                       }))
        all.push_back({plane, side});
    }
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    const Body &whole = whole_of(*bodies[b], bodies);
    for (const SymmetryWall &wall : all)
    {
      const Extent e = extent(whole, wall.plane.axis);
      const double first = wall.side > 0. ? e.low - wall.plane.coordinate
                                          : wall.plane.coordinate - e.high;
      const double tolerance = round_off * (e.high - e.low);
      if (first < -tolerance)
        continue;
      walls[b].push_back(wall);
      for (const SymmetryPlane &own : whole.planes_of_symmetry())
        if (own.axis == wall.plane.axis &&
            std::abs(own.coordinate - wall.plane.coordinate) <= tolerance)
          walls[b].back().held_within = tolerance;
    }
  }
  return walls;
}

SymmetryWalls::SymmetryWalls(const std::vector<Body *> &bodies,
                             MPI_Comm communicator)
    : Coupling("planes of symmetry"), bodies(bodies),
      communicator(communicator), walls(find_symmetry_walls(bodies)),
      impulse(bodies.size())
{
  for (const auto &of_body : walls)
    of_axes.push_back(by_axes(of_body));
}

bool SymmetryWalls::any() const
{
  return std::any_of(walls.begin(), walls.end(),
                     [](const auto &of_body) { return !of_body.empty(); });
}

void SymmetryWalls::add_forces(const double dt)
{
  std::vector<Held> before;
  before.swap(held);
  if (!is_step(dt))
    return;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const WallsOfAxes &of : of_axes[b])
      hold_at(of, b, dt, before);
}

std::vector<SymmetryWalls::WallsOfAxes>
SymmetryWalls::by_axes(const std::vector<SymmetryWall> &of_body)
{
  std::vector<WallsOfAxes> sets;
  for (const SymmetryWall &wall : of_body)
  {
    const int axis = wall.plane.axis;
    auto set = std::find_if(sets.begin(), sets.end(),
                            [&](const WallsOfAxes &of)
                            { return of.wall[axis] == nullptr; });
    if (set == sets.end())
      set = sets.insert(set, WallsOfAxes());
    set->coordinate[axis] = wall.plane.coordinate;
    set->side[axis] = wall.side;
    set->wall[axis] = &wall;
  }
  return sets;
}

void SymmetryWalls::hold_at(const WallsOfAxes &of, const std::size_t b,
                            const double dt, const std::vector<Held> &before)
{
  const NodalState &nodes = bodies[b]->nodes();
  const double step = bodies[b]->moves_node_by_node() ? dt : 0.;
  const Vec coordinate = of.coordinate, side = of.side;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    // The mass times where it would be, one step on, for all axes at once.
    const Vec next =
        side * (nodes.inertia[i] * (nodes.position[i] - coordinate +
                                    step * nodes.velocity[i]) +
                step * step * nodes.force[i]);
    const auto beyond = next < 0.;
    if (!(beyond[0] | beyond[1] | beyond[2]))
      continue;
    for (int axis = 0; axis < 3; ++axis)
      if (beyond[axis] && !nodes.is_follower(i) &&
          !(of.wall[axis]->distance(nodes.reference_position[i]) <=
            of.wall[axis]->held_within))
        hold({std::uint32_t(b), std::uint32_t(i), axis, dt, Vec{}},
             *of.wall[axis], next[axis], before);
  }
}

void SymmetryWalls::hold(Held h, const SymmetryWall &wall, const double next,
                         const std::vector<Held> &before)
{
  NodalState &nodes = bodies[h.body]->nodes();
  const bool is_rigid = !bodies[h.body]->moves_node_by_node();
  const std::size_t i = h.node;
  const int axis = h.axis;
  const double dt = h.step, v = wall.side * nodes.velocity[i][axis],
               f = wall.side * nodes.force[i][axis], m = nodes.inertia[i];
  const bool bounces = !is_rigid && -m * v > 2. * dt * std::abs(f);
  if (is_rigid)
    for (const Held &b : before)
      if (b.body == h.body && b.node == h.node && b.axis == axis)
        h.step = std::max(dt, b.step);
  h.force[axis] = wall.side * (bounces ? -2. * (m * v / dt + f)
                                       : -next / (h.step * h.step));
  nodes.force[i] += h.force;
  held.push_back(h);
  farthest = std::max(farthest, -wall.distance(nodes.position[i]));
}

void SymmetryWalls::accumulate_work(const double half_dt)
{
  for (const Held &h : held)
  {
    work.add(half_dt * dot(h.force, bodies[h.body]->nodes().velocity[h.node]));
    impulse[h.body].add(half_dt * h.force);
  }
}

void SymmetryWalls::add_energies(EnergyLedger &ledger) const
{
  ledger.contact.subtract(work);
}

Measures SymmetryWalls::measure() const
{
  double beyond = farthest;
  MPI_Allreduce(MPI_IN_PLACE, &beyond, 1, MPI_DOUBLE, MPI_MAX, communicator);
  ExactSum done = work;
  ExactSum::reduce({&done}, communicator);
  return {{"beyond a plane max", "m", beyond},
          {"contact energy", "J", -done.value()}};
}

std::vector<Resultant> SymmetryWalls::resultants() const
{
  std::vector<ExactVectorSum> force(bodies.size()), total = impulse;
  for (const Held &h : held)
    force[h.body].add(h.force);
  std::vector<ExactVectorSum *> sums;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sums.insert(sums.end(), {&force[b], &total[b]});
  ExactVectorSum::reduce(sums, communicator);
  std::vector<Resultant> all;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!walls[b].empty())
      all.push_back({name, int(b), force[b].value(), total[b].value(), true});
  return all;
}

void SymmetryWalls::visit_state(StateVisitor &visitor)
{
  // Half of the work of these forces is still to be counted.
  std::vector<SavedHeld> saved;
  for (const Held &h : held)
    saved.push_back({h.body, h.axis, bodies[h.body]->nodes().global_id[h.node],
                     h.step, h.force});
  visitor.visit_all("held nodes", saved);
  visitor.visit_sum("work at planes", work);
  visitor.visit_sums("impulses at planes", impulse);
  visitor.visit_largest("farthest beyond planes", farthest);
  if (visitor.is_restoring())
    restore_held(std::move(saved));
}

void SymmetryWalls::restore_held(std::vector<SavedHeld> saved)
{
  // Those of a node come from one rank, in the order of its walls.
  std::stable_sort(saved.begin(), saved.end(),
                   [](const SavedHeld &a, const SavedHeld &b) {
                     return a.body != b.body ? a.body < b.body
                                             : a.node < b.node;
                   });
  held.clear();
  for (const SavedHeld &h : saved)
  {
    const NodalState &nodes = bodies[h.body]->nodes();
    const auto end = nodes.global_id.begin() + nodes.n_owned,
               at = std::lower_bound(nodes.global_id.begin(), end, h.node);
    if (at != end && *at == h.node)
      held.push_back({std::uint32_t(h.body),
                      std::uint32_t(at - nodes.global_id.begin()), h.axis,
                      h.step, h.force});
  }
}
} // namespace sabot
