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
  // Twice: surfaces stretch.
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
      OpenParticle particle{};
      particle.key = {std::int32_t(b), 0, nodes.global_id[i]};
      particle.x = x;
      particle.share = shares.empty() ? 1. : shares[i];
      if (!is_loose[i])
      {
        const SurfacePoint point = bodies[b]->surface_point(i);
        if (point.spacing == 0.)
          continue;
        particle.is_sound = 1;
        // Tied followers are inside of what they are tied to.
        particle.reach = nodes.inertia[i] > 0.
                             ? std::sqrt(2.) * reach * point.spacing + skin
                             : 0.;
      }
      my_particles.push_back(particle);
    }
  }
  std::vector<OpenParticle> my_sound;
  double longest = skin;
  for (const OpenParticle &particle : my_particles)
    if (particle.reach > 0.)
      my_sound.push_back(particle);
  sound = gather_all(my_sound, communicator);
  std::sort(sound.begin(), sound.end(),
            [](const OpenParticle &a, const OpenParticle &b)
            { return a.key < b.key; });
  for (const OpenParticle &particle : sound)
    longest = std::max(longest, particle.reach);
  for (std::size_t s = 0; s < sound.size(); ++s)
  {
    auto &of_body = buckets[sound[s].key.body];
    if (!of_body)
      of_body = std::make_unique<PointBuckets>(longest);
    of_body->add(sound[s].x, s);
  }
}

void ParticleSearch::near(const OpenParticle &node, const int other,
                          std::vector<NodeKey> &found) const
{
  if (!buckets[other])
    return;
  const std::size_t first = found.size();
  buckets[other]->for_near(node.x,
                           [&](const std::size_t s)
                           {
                             if (norm_square(sound[s].x - node.x) <
                                 sound[s].reach * sound[s].reach)
                               found.push_back(sound[s].key);
                           });
  std::sort(found.begin() + first, found.end());
}
} // namespace sabot
