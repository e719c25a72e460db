// What a zone that finds itself has found.
#include "sabot/simulation/found_zone.h"

#include "sabot/base/text.h"
#include "sabot/bodies/conversion.h"

#include <algorithm>
#include <limits>

namespace sabot
{
std::vector<FoundZone> find_grown(const Scene &scene, MPI_Comm communicator)
{
  std::vector<FoundZone> all;
  for (const GrowingZone &zone : scene.growing)
  {
    Body &body = *scene.bodies[zone.zone];
    FoundZone found;
    found.zone = body.name;
    found.host = scene.bodies[zone.host]->name;
    found.n_particles = body.particle_sink()->sites().size();
    constexpr double far = std::numeric_limits<double>::max();
    std::array<double, 6> bounds; // low, and minus high
    bounds.fill(far);
    const NodalState &nodes = body.nodes();
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const Vec X = nodes.reference_position[i];
      const auto x = zone.turn.origin({{X[0], X[1], X[2]}});
      for (int d = 0; d < 3; ++d)
      {
        bounds[d] = std::min(bounds[d], x[d]);
        bounds[3 + d] = std::min(bounds[3 + d], -x[d]);
      }
    }
    MPI_Allreduce(MPI_IN_PLACE, bounds.data(), 6, MPI_DOUBLE, MPI_MIN,
                  communicator);
    if (found.n_particles > 0)
      for (int d = 0; d < 3; ++d)
      {
        found.low[d] = bounds[d];
        found.high[d] = -bounds[3 + d];
      }
    all.push_back(found);
  }
  return all;
}

std::string describe(const FoundZone &found)
{
  std::string text = found.zone + " in " + found.host + ": ";
  if (found.n_particles == 0)
    return text + "no cell has turned into particles";
  const auto vector = [](const double x, const double y, const double z)
  {
    return formatted("%.6g mm, ", 1e3 * x) + formatted("%.6g mm, ", 1e3 * y) +
           formatted("%.6g mm", 1e3 * z);
  };
  const auto &a = found.low, &b = found.high;
  return text +
         formatted("%.0f particles; as a fixed zone: Size = ",
                   double(found.n_particles)) +
         vector(b[0] - a[0], b[1] - a[1], b[2] - a[2]) + "; Center = " +
         vector(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]));
}
} // namespace sabot
