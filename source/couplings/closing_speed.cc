// How fast nodes of two bodies can come closer.
#include "sabot/couplings/closing_speed.h"

#include "sabot/couplings/box_buckets.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
double ClosingSpeed::largest(const std::vector<Body *> &bodies,
                             const std::vector<std::pair<int, int>> &pairs,
                             MPI_Comm communicator, const unsigned int mirrored)
{
  const std::size_t n = bodies.size();
  std::vector<char> used(n, 0);
  for (const auto &pair : pairs)
    used[pair.first] = used[pair.second] = 1;
  // Squares of bodies, then the box around all velocities, for the next time.
  std::vector<double> top(n + 6, 0.);
  std::fill(top.begin() + n, top.end(), -1e300);
  for (std::size_t b = 0; b < n; ++b)
    if (used[b])
    {
      const NodalState &nodes = bodies[b]->nodes();
      Box box;
      double square = 0.;
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
      {
        const Vec v = nodes.velocity[i];
        box.add(v);
        square = std::max(square, norm_square(v - middle));
      }
      top[b] = square;
      for (int d = 0; d < 3; ++d)
      {
        top[n + d] = std::max(top[n + d], -box.low[d]);
        top[n + 3 + d] = std::max(top[n + 3 + d], box.high[d]);
      }
    }
  MPI_Allreduce(MPI_IN_PLACE, top.data(), top.size(), MPI_DOUBLE, MPI_MAX,
                communicator);
  for (int d = 0; d < 3; ++d)
    middle[d] = mirrored >> d & 1 ? 0. : 0.5 * (top[n + 3 + d] - top[n + d]);
  double speed = 0.;
  for (const auto &pair : pairs)
    speed = std::max(speed,
                     std::sqrt(top[pair.first]) + std::sqrt(top[pair.second]));
  return speed;
}
} // namespace sabot
