// Loose particles of all ranks, and their images in planes of symmetry.
#include "sabot/couplings/debris.h"

#include "sabot/base/send_some.h"
#include "sabot/couplings/box_buckets.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
Debris::Debris(const std::vector<Body *> &bodies,
               const std::vector<std::pair<int, int>> &body_pairs)
{
  const std::size_t n_bodies = bodies.size();
  views.resize(n_bodies);
  meet.assign(n_bodies * n_bodies, 0);
  std::vector<char> used(n_bodies, 0);
  for (const auto &[a, b] : body_pairs)
  {
    meet[a * n_bodies + b] = meet[b * n_bodies + a] = 1;
    used[a] = used[b] = 1;
  }
  for (std::size_t b = 0; b < n_bodies; ++b)
  {
    if (!used[b])
      continue;
    const DebrisView &view = views[b] = bodies[b]->particles()->debris();
    largest_spacing = std::max(largest_spacing, view.spacing);
    const NodalState &nodes = bodies[b]->nodes();
    for (std::size_t k = 0; k < view.nodes.size(); ++k)
    {
      const std::size_t i = view.nodes[k];
      mine.push_back({{std::int32_t(b), 0, nodes.global_id[i]},
                      i,
                      !view.is_continuous.empty() && view.is_continuous[k],
                      nodes.position[i]});
    }
  }
}

void Debris::gather_near(const DebrisImages &images, const double reach,
                         MPI_Comm communicator)
{
  n_all = mine.size();
  MPI_Allreduce(MPI_IN_PLACE, &n_all, 1, MPI_INT64_T, MPI_SUM, communicator);
  int rank;
  MPI_Comm_rank(communicator, &rank);
  Box around;
  for (const LooseParticle &p : mine)
    around.add(p.x);
  around.inflate((1. + 1e-9) * reach);
  const std::vector<Box> boxes = boxes_of_ranks(around, communicator);
  std::vector<std::vector<LooseParticle>> to_rank(boxes.size());
  to_rank[rank] = mine;
  std::vector<std::size_t> last(boxes.size(), mine.size()); // that was told
  if (boxes.size() > 1)
    for (const DebrisImages::Item &item : images.with_images(mine, reach))
      for (std::size_t r = 0; r < boxes.size(); ++r)
        if (int(r) != rank && last[r] != item.number &&
            boxes[r].contains(item.x))
        {
          to_rank[r].push_back(mine[item.number]);
          last[r] = item.number;
        }
  near = send_some(to_rank, communicator);
}

DebrisImages::DebrisImages(const std::vector<Body *> &bodies)
    : of_body(bodies.size(), 0)
{
  const auto walls_of = find_symmetry_walls(bodies);
  for (std::size_t b = 0; b < walls_of.size(); ++b)
    for (const SymmetryWall &wall : walls_of[b])
    {
      const auto known = std::find_if(walls.begin(), walls.end(),
                                      [&](const SymmetryWall &other) {
                                        return other.plane == wall.plane &&
                                               other.side == wall.side;
                                      });
      of_body[b] |= std::uint64_t(1) << (known - walls.begin());
      if (known == walls.end())
        walls.push_back(wall);
    }
}

Vec DebrisImages::mirrored(const std::uint64_t image, Vec x) const
{
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (image >> w & 1)
    {
      const SymmetryPlane &plane = walls[w].plane;
      x[plane.axis] = 2. * plane.coordinate - x[plane.axis];
    }
  return x;
}

unsigned int DebrisImages::turned_axes(const std::uint64_t image) const
{
  unsigned int axes = 0;
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (image >> w & 1)
      axes ^= 1u << walls[w].plane.axis;
  return axes;
}

Vec DebrisImages::to_own_image(const std::uint64_t image, Vec offset) const
{
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (image >> w & 1)
    {
      double &component = offset[walls[w].plane.axis];
      component = -walls[w].side * std::abs(component);
    }
  return offset;
}

std::uint64_t DebrisImages::near(const int body, const Vec x,
                                 const double reach) const
{
  // What is held on a plane stays there to the last bit.
  std::uint64_t found = 0;
  for (std::size_t w = 0; w < walls.size(); ++w)
  {
    const double distance = std::abs(walls[w].distance(x));
    if (of_body[body] >> w & 1 && distance < reach && distance > 0.)
      found |= std::uint64_t(1) << w;
  }
  return found;
}

int DebrisImages::n_common_planes(const LooseParticle &a,
                                  const LooseParticle &b) const
{
  int n = 0;
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (of_body[a.key.body] >> w & of_body[b.key.body] >> w & 1 &&
        walls[w].distance(a.x) == 0. && walls[w].distance(b.x) == 0.)
      ++n;
  return n;
}

std::vector<DebrisImages::Item>
DebrisImages::with_images(const std::vector<LooseParticle> &particles,
                          const double reach) const
{
  std::vector<Item> items;
  for (std::size_t i = 0; i < particles.size(); ++i)
  {
    const LooseParticle &p = particles[i];
    const std::uint64_t planes = near(p.key.body, p.x, reach);
    // All parts of this set of planes, the empty one first.
    std::uint64_t image = 0;
    do
    {
      items.push_back({i, image, mirrored(image, p.x)});
      image = (image - planes) & planes;
    } while (image != 0);
  }
  return items;
}
} // namespace sabot
