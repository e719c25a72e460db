// How fast nodes of two bodies can come closer.
#include "sabot/couplings/closing_speed.h"

#include "sabot/couplings/box_buckets.h"
#include "sabot/kernels/pack.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Of n velocities less @p middle, four at a time; @p box grows around all. */
double largest_square(const Vec *const velocity, const std::size_t n,
                      const Vec middle, Box &box)
{
  Pack square = {};
  std::size_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes)
  {
    for (std::size_t k = 0; k < n_lanes; ++k)
      box.add(velocity[i + k]);
    constexpr std::uint32_t four[n_lanes] = {0, 1, 2, 3};
    Pack v[3];
    gather(velocity + i, four, v);
    Pack sum = {};
    for (int d = 0; d < 3; ++d)
      sum += (v[d] - middle[d]) * (v[d] - middle[d]);
    square = pack_max(sum, square);
  }
  double largest = std::max({0., square[0], square[1], square[2], square[3]});
  for (; i < n; ++i)
  {
    box.add(velocity[i]);
    largest = std::max(largest, norm_square(velocity[i] - middle));
  }
  return largest;
}

/** Across which any body has planes of symmetry, a bit each. */
unsigned int axes_of_symmetry(const std::vector<Body *> &bodies)
{
  unsigned int axes = 0;
  for (const Body *body : bodies)
    for (const SymmetryPlane &plane : body->planes_of_symmetry())
      axes |= 1u << plane.axis;
  return axes;
}
} // namespace

double ClosingSpeed::largest(const std::vector<Body *> &bodies,
                             const std::vector<std::pair<int, int>> &pairs,
                             MPI_Comm communicator)
{
  const std::size_t n = bodies.size();
  std::vector<char> used(n, 0);
  for (const auto &pair : pairs)
    used[pair.first] = used[pair.second] = 1;
  // Squares of bodies, then the box around all velocities, for the next time.
  std::vector<double> top(n + 6, 0.);
  std::fill(top.begin() + n, top.end(), -1e300);
  if (!mirrored)
    mirrored = axes_of_symmetry(bodies);
  for (std::size_t b = 0; b < n; ++b)
    if (used[b])
    {
      const NodalState &nodes = bodies[b]->nodes();
      Box box;
      top[b] =
          largest_square(nodes.velocity.data(), nodes.n_owned, middle, box);
      for (int d = 0; d < 3; ++d)
      {
        top[n + d] = std::max(top[n + d], -box.low[d]);
        top[n + 3 + d] = std::max(top[n + 3 + d], box.high[d]);
      }
    }
  MPI_Allreduce(MPI_IN_PLACE, top.data(), top.size(), MPI_DOUBLE, MPI_MAX,
                communicator);
  for (int d = 0; d < 3; ++d)
    middle[d] = *mirrored >> d & 1 ? 0. : 0.5 * (top[n + 3 + d] - top[n + d]);
  double speed = 0.;
  for (const auto &pair : pairs)
    speed = std::max(speed,
                     std::sqrt(top[pair.first]) + std::sqrt(top[pair.second]));
  return speed;
}
} // namespace sabot
