#include "sabot/couplings/particle_search.h"

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

/** Longest semi-axis of the ellipsoid |@p to_unit x| = 1, from above: the row
    sums of H H^T bound its eigenvalues. */
double largest_axis(const Mat &to_unit)
{
  const Mat axes = inverse(to_unit);
  const Mat square = axes * transpose(axes);
  double largest = 0.;
  for (int d = 0; d < 3; ++d)
    largest =
        std::max(largest, std::abs(square(d, 0)) + std::abs(square(d, 1)) +
                              std::abs(square(d, 2)));
  return std::sqrt(largest);
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
      spacing = std::max(spacing, surfaces[b].spacing);
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
  {
    const NodalState &nodes = bodies[b]->nodes();
    const std::vector<double> &shares = surfaces[b].node_share;
    std::vector<char> is_loose(others[b].empty() ? 0 : nodes.n_owned, 0);
    if (!others[b].empty())
      for (const std::size_t i : bodies[b]->debris().nodes)
        is_loose[i] = 1;
    for (std::size_t i = 0; i < is_loose.size(); ++i)
    {
      const Vec x = nodes.position[i];
      if (std::none_of(others[b].begin(), others[b].end(),
                       [&](const int other)
                       { return extent[other].contains(x); }))
        continue;
      SearchedParticle particle{};
      particle.key = {std::int32_t(b), 0, nodes.global_id[i]};
      particle.x = x;
      particle.share = shares.empty() ? 1. : shares[i];
      const SurfacePoint point =
          is_loose[i] ? SurfacePoint() : bodies[b]->surface_point(i);
      particle.is_on_surface = point.spacing > 0.;
      particle.is_open = is_loose[i] || particle.is_on_surface;
      // Tied followers are inside of what they are tied to.
      if (nodes.inertia[i] > 0.)
        particle.reach =
            std::max(std::sqrt(2.) * reach * point.spacing,
                     largest_axis(bodies[b]->volume_point(i).to_unit)) +
            skin;
      my_particles.push_back(particle);
    }
  }
  std::vector<SearchedParticle> my_touchable;
  for (const SearchedParticle &particle : my_particles)
    if (particle.reach > 0.)
      my_touchable.push_back(particle);
  touchable = gather_all(my_touchable, communicator);
  std::sort(touchable.begin(), touchable.end(),
            [](const SearchedParticle &a, const SearchedParticle &b)
            { return a.key < b.key; });
  double longest = skin;
  for (const SearchedParticle &particle : touchable)
    longest = std::max(longest, particle.reach);
  for (std::size_t s = 0; s < touchable.size(); ++s)
  {
    auto &of_body = buckets[touchable[s].key.body];
    if (!of_body)
      of_body = std::make_unique<PointBuckets>(longest);
    of_body->add(touchable[s].x, s);
  }
}

void ParticleSearch::near(const SearchedParticle &node, const int other,
                          std::vector<Member> &found) const
{
  if (!buckets[other])
    return;
  const std::size_t first = found.size();
  buckets[other]->for_near(
      node.x,
      [&](const std::size_t s)
      {
        const SearchedParticle &there = touchable[s];
        if (norm_square(there.x - node.x) < there.reach * there.reach)
          found.push_back({there.key, there.is_on_surface});
      });
  std::sort(found.begin() + first, found.end(),
            [](const Member &a, const Member &b) { return a.key < b.key; });
}
} // namespace sabot
