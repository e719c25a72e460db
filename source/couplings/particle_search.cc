// Particles of several bodies near each other.
#include "sabot/couplings/particle_search.h"

#include "sabot/base/send_some.h"
#include "sabot/couplings/box_buckets.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
Box box_of(const Body &body, MPI_Comm communicator)
{
  Box box;
  const NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    box.add(nodes.position[i]);
  box.reduce(communicator);
  return box;
}

/** Of all axes, sum of squares of the entries: bounds the largest stretch. */
double frobenius(const Mat &A)
{
  return std::sqrt(norm_square(A.row[0]) + norm_square(A.row[1]) +
                   norm_square(A.row[2]));
}

/** Where nodes may touch @p particle. */
Box box_around(const SearchedParticle &particle)
{
  // The ellipsoid's half width along an axis is the length of a row of H.
  const Mat axes = inverse(particle.to_unit);
  Box box;
  Vec half;
  for (int d = 0; d < 3; ++d)
    half[d] = std::max(particle.reach, particle.unit_reach *
                                           std::sqrt(axes(d, 0) * axes(d, 0) +
                                                     axes(d, 1) * axes(d, 1) +
                                                     axes(d, 2) * axes(d, 2)));
  box.add(particle.x - half);
  box.add(particle.x + half);
  return box;
}
} // namespace

ParticleSearch::ParticleSearch(const std::vector<Body *> &bodies,
                               const std::vector<std::pair<int, int>> &pairs,
                               const double skin, MPI_Comm communicator)
    : surfaces(bodies.size()), buckets(bodies.size())
{
  std::vector<std::vector<int>> others(bodies.size());
  for (const auto &[a, b] : pairs)
  {
    others[a].push_back(b);
    others[b].push_back(a);
  }
  double spacing = 0.;
  std::vector<Box> extent(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!others[b].empty())
    {
      extent[b] = box_of(*bodies[b], communicator);
      surfaces[b] = bodies[b]->contact_surface();
      spacing =
          std::max({spacing, surfaces[b].spacing, surfaces[b].largest_spacing});
    }
  // Twice: bodies stretch.
  const double margin = 2. * std::sqrt(2.) * reach * spacing + skin;
  smallest_gap = 1e300;
  for (const auto &[a, b] : pairs)
    smallest_gap = std::min(smallest_gap, extent[a].distance(extent[b]));
  smallest_gap -= margin;
  if (smallest_gap > 0.)
    return;
  for (Box &box : extent)
    box.inflate(margin);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!others[b].empty())
      find_mine(*bodies[b], b, others[b], extent, skin);
  gather_touchable(communicator);
}

void ParticleSearch::find_mine(const Body &body, const std::int32_t number,
                               const std::vector<int> &others,
                               const std::vector<Box> &extent,
                               const double skin)
{
  const NodalState &nodes = body.nodes();
  const ParticleView &view = *body.particles();
  const std::vector<double> &shares = surfaces[number].node_share;
  std::vector<char> is_loose(nodes.n_owned, 0);
  for (const std::size_t i : view.debris().nodes)
    is_loose[i] = 1;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const Vec x = nodes.position[i];
    if (std::none_of(others.begin(), others.end(),
                     [&](const int other)
                     { return extent[other].contains(x); }))
      continue;
    SearchedParticle particle{};
    particle.key = {number, 0, nodes.global_id[i]};
    particle.x = x;
    particle.share = shares.empty() ? 1. : shares[i];
    const SurfacePoint point =
        is_loose[i] ? SurfacePoint() : view.surface_point(i);
    particle.is_on_surface = point.spacing > 0.;
    particle.is_open = is_loose[i] || particle.is_on_surface;
    // Tied followers are inside of what they are tied to.
    if (!nodes.is_follower(i))
    {
      particle.reach = std::sqrt(2.) * reach * point.spacing + skin;
      particle.to_unit = view.volume_point(i).to_unit;
      // It may change its shape somewhat until the next search.
      particle.unit_reach = 1.2 + skin * frobenius(particle.to_unit);
    }
    my_particles.push_back(particle);
  }
}

void ParticleSearch::gather_touchable(MPI_Comm communicator)
{
  Box mine;
  for (const SearchedParticle &particle : my_particles)
    mine.add(particle.x);
  double spacing = 0.;
  for (const ContactSurface &its : surfaces)
    spacing = std::max(spacing, its.spacing);
  mine.inflate(1e-9 * spacing); // round-off
  const std::vector<Box> boxes = boxes_of_ranks(mine, communicator);
  std::vector<std::vector<SearchedParticle>> to_rank(boxes.size());
  for (const SearchedParticle &particle : my_particles)
    for (std::size_t r = 0; r < boxes.size() && particle.unit_reach > 0.; ++r)
      if (boxes[r].meets(box_around(particle)))
        to_rank[r].push_back(particle);
  touchable = send_some(to_rank, communicator);
  std::sort(touchable.begin(), touchable.end(),
            [](const SearchedParticle &a, const SearchedParticle &b)
            { return a.key < b.key; });
  const std::size_t n_bodies = buckets.size();
  first.assign(n_bodies + 1, touchable.size());
  for (std::size_t s = touchable.size(); s-- > 0;)
    first[touchable[s].key.body] = s;
  for (std::size_t b = n_bodies; b-- > 0;)
    first[b] = std::min(first[b], first[b + 1]);
  for (std::size_t b = 0; b < n_bodies; ++b)
  {
    std::vector<Box> boxes;
    for (std::size_t s = first[b]; s < first[b + 1]; ++s)
      boxes.push_back(box_around(touchable[s]));
    if (!boxes.empty())
      buckets[b] =
          std::make_unique<BoxBuckets>(boxes, reach * surfaces[b].spacing);
  }
}

void ParticleSearch::near(const SearchedParticle &node, const int other,
                          std::vector<Member> &found) const
{
  if (!buckets[other])
    return;
  const auto [begin, end] = buckets[other]->find(node.x);
  for (const std::int32_t *item = begin; item != end; ++item)
  {
    const SearchedParticle &there = touchable[first[other] + *item];
    const Vec d = node.x - there.x;
    if ((there.is_on_surface && norm_square(d) < there.reach * there.reach) ||
        norm_square(there.to_unit * d) < there.unit_reach * there.unit_reach)
      found.push_back({there.key, there.is_on_surface});
  }
}
} // namespace sabot
