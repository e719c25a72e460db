// The step limit of bodies that close in on each other.
#include "sabot/couplings/closing_limit.h"

#include "sabot/couplings/pressing_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace sabot
{
namespace
{
constexpr double part_of_rigid = 0.01, part_of_others = 0.03;
/** What a step forgets of the speed at which rigid bodies met. */
constexpr double forgets = 0.0005;
/** Looks between two at bodies that deform. */
constexpr std::uint64_t interval = 10;
constexpr double far = std::numeric_limits<double>::max();

bool deforms(const Body &body)
{
  return body.moves_node_by_node();
}

/** Whether no force can move it. */
bool is_prescribed(const Body &body)
{
  return !deforms(body) && body.is_held();
}
} // namespace

ClosingLimit::ClosingLimit(
    const std::vector<Body *> &bodies,
    const std::vector<std::unique_ptr<Coupling>> &couplings,
    MPI_Comm communicator)
    : Coupling("closing speed"), bodies(bodies), communicator(communicator),
      is_used(bodies.size(), 0), spacing(bodies.size(), 0.),
      motions(bodies.size())
{
  for (const Body *body : bodies)
    is_rigid.push_back(!deforms(*body));
  // Where several hold two bodies apart the softest counts.
  std::map<std::pair<int, int>, double> known;
  for (const auto &coupling : couplings)
    for (const auto &[first, second] : coupling->holds_apart())
    {
      const auto added = known.emplace(std::minmax(first, second),
                                       coupling->stability_fraction());
      added.first->second =
          std::min(added.first->second, coupling->stability_fraction());
    }
  for (const auto &[members, fraction] : known)
  {
    const auto [a, b] = members;
    if (a != b && !(is_prescribed(*bodies[a]) && is_prescribed(*bodies[b])))
      pairs.push_back(
          {a, b, is_rigid[a] && is_rigid[b],
           is_rigid[a] && is_rigid[b] ? part_of_rigid : part_of_others, 0.,
           fraction});
  }
  const auto walls = find_symmetry_walls(bodies);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const SymmetryWall &wall : walls[b])
      if (is_rigid[b] && !is_prescribed(*bodies[b]))
      {
        // All of the other side of the plane.
        Motion all{vec(-far, -far, -far), vec(far, far, far), {}, {}};
        (wall.side > 0. ? all.high : all.low)[wall.plane.axis] =
            wall.plane.coordinate;
        pairs.push_back(
            {int(b), int(motions.size()), true, part_of_rigid, 0., 0.});
        motions.push_back(all);
      }
  for (const Pair &pair : pairs)
    for (const int m : {pair.a, pair.b})
      if (m < int(bodies.size()))
        is_used[m] = 1;
}

double ClosingLimit::part_of_pair(const Pair &pair) const
{
  constexpr double deepest = 0.25; // over the spacing
  double lightest = far, inverse_mass = 0.;
  for (const int m : {pair.a, pair.b})
  {
    const NodalState &nodes = bodies[m]->nodes();
    ExactSum mass;
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      mass.add(nodes.lumped_mass[i]);
      if (!is_prescribed(*bodies[m]))
        lightest = std::min(lightest, nodes.inertia[i]);
    }
    ExactSum::reduce({&mass}, communicator);
    if (!is_prescribed(*bodies[m]))
      inverse_mass += 1. / mass.value();
  }
  MPI_Allreduce(MPI_IN_PLACE, &lightest, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return std::min(part_of_rigid, deepest * std::sqrt(pair.stability_fraction *
                                                     lightest * inverse_mass));
}

void ClosingLimit::initialize()
{
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (is_used[b])
      spacing[b] = bodies[b]->contact_surface().spacing;
  for (Pair &pair : pairs)
    if (pair.both_rigid && pair.b < int(bodies.size()))
      pair.part = part_of_pair(pair);
  for (Pair &pair : pairs)
    pair.spacing = pair.b < int(bodies.size())
                       ? std::min(spacing[pair.a], spacing[pair.b])
                       : spacing[pair.a];
}

void ClosingLimit::find_motions()
{
  const bool all = n_looks++ % interval == 0;
  std::vector<double> bounds(12 * bodies.size(), far);
  std::vector<ExactSum> sums(4 * bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    if (!is_used[b] || !(is_rigid[b] || all))
      continue;
    const NodalState &nodes = bodies[b]->nodes();
    double *const bound = &bounds[12 * b];
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const Vec x = nodes.position[i], v = nodes.velocity[i];
      for (int d = 0; d < 3; ++d)
      {
        bound[d] = std::min(bound[d], x[d]);
        bound[3 + d] = std::min(bound[3 + d], -x[d]);
        if (is_rigid[b])
        {
          bound[6 + d] = std::min(bound[6 + d], v[d]);
          bound[9 + d] = std::min(bound[9 + d], -v[d]);
        }
        else
          sums[4 * b + d].add(nodes.lumped_mass[i] * v[d]);
      }
      if (!is_rigid[b])
        sums[4 * b + 3].add(nodes.lumped_mass[i]);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, bounds.data(), bounds.size(), MPI_DOUBLE, MPI_MIN,
                communicator);
  if (all)
  {
    std::vector<ExactSum *> pointers;
    for (ExactSum &sum : sums)
      pointers.push_back(&sum);
    ExactSum::reduce(pointers, communicator);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    if (!is_used[b] || !(is_rigid[b] || all))
      continue;
    const double *const bound = &bounds[12 * b];
    Motion &motion = motions[b];
    // Round surfaces stand out from their nodes; until the next look the nodes
    // of others move on.
    const double margin = (is_rigid[b] ? most_bulge : 1.) * spacing[b];
    for (int d = 0; d < 3; ++d)
    {
      motion.low[d] = bound[d] - margin;
      motion.high[d] = -bound[3 + d] + margin;
      const double mean =
          is_rigid[b] ? 0. : sums[4 * b + d].value() / sums[4 * b + 3].value();
      motion.slowest[d] = is_rigid[b] ? bound[6 + d] : mean;
      motion.fastest[d] = is_rigid[b] ? -bound[9 + d] : mean;
    }
  }
}

double ClosingLimit::time_to_meet(const Motion &a, const Motion &b)
{
  double time = 0.;
  for (int d = 0; d < 3; ++d)
    for (const auto &[lower, upper] :
         {std::make_pair(&a, &b), std::make_pair(&b, &a)})
    {
      const double gap = upper->low[d] - lower->high[d],
                   closing = lower->fastest[d] - upper->slowest[d];
      if (gap > 0.)
        time = std::max(time, closing > 0. ? gap / closing : far);
    }
  return time;
}

void ClosingLimit::bound_step(Pair &pair, const double dt)
{
  const Motion &a = motions[pair.a], &b = motions[pair.b];
  Vec most = {};
  for (int d = 0; d < 3; ++d)
    most[d] = std::max(std::abs(a.fastest[d] - b.slowest[d]),
                       std::abs(b.fastest[d] - a.slowest[d]));
  const double speed = norm(most), time = time_to_meet(a, b);
  pair.reference = pair.both_rigid && time == 0.
                       ? std::max(speed, (1. - forgets) * pair.reference)
                       : speed;
  if (time == 0. && is_step(dt))
    largest = std::max(largest, speed * dt / pair.spacing);
  if (!(pair.reference > 0.) || !(time < far))
    return;
  const double step = pair.part * pair.spacing / pair.reference + 0.5 * time;
  if (step < limit.dt)
    limit = {step, &pair - pairs.data()};
}

void ClosingLimit::add_forces(const double dt)
{
  find_motions();
  limit = StableStep();
  for (Pair &pair : pairs)
    bound_step(pair, dt);
}

Measures ClosingLimit::measure() const
{
  return {{"closing per step over spacing max", "1", largest}};
}

void ClosingLimit::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("motions", motions);
  std::vector<double> references;
  for (const Pair &pair : pairs)
    references.push_back(pair.reference);
  visitor.visit_array("speeds of pairs", references);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    pairs[p].reference = references[p];
  visitor.visit_value("looks", n_looks);
  visitor.visit_value("limit", limit);
  visitor.visit_value("largest closing", largest);
}
} // namespace sabot
