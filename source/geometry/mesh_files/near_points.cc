// Points that lie at nearly the same place.
#include "sabot/geometry/near_points.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace sabot
{
namespace
{
using Place = std::array<double, 3>; // whole numbers

struct PlaceHash
{
  std::size_t operator()(const Place &place) const
  {
    std::uint64_t hash = 1469598103934665603u;
    for (const double d : place)
      hash = (hash ^ std::hash<double>()(d)) * 1099511628211u;
    return hash ^ hash >> 29;
  }
};

double square_of(const std::array<double, 3> &x, const std::array<double, 3> &y)
{
  double square = 0.;
  for (int d = 0; d < 3; ++d)
    square += (x[d] - y[d]) * (x[d] - y[d]);
  return square;
}
} // namespace

std::vector<std::size_t>
first_near(const std::vector<std::array<double, 3>> &points,
           const double distance)
{
  // Cubes of four distances: a point sees two along an axis at most.
  const double cube = 4. * distance;
  std::unordered_map<Place, std::vector<std::size_t>, PlaceHash> in_cube;
  std::vector<std::size_t> first(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    first[i] = i;
    const auto &x = points[i];
    Place low, high;
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::floor((x[d] - distance) / cube);
      high[d] = std::floor((x[d] + distance) / cube);
    }
    Place at;
    for (int corner = 0; corner < 8 && first[i] == i; ++corner)
    {
      bool is_new = true;
      for (int d = 0; d < 3; ++d)
      {
        const bool up = corner & 1 << d;
        at[d] = up ? high[d] : low[d];
        is_new = is_new && !(up && high[d] == low[d]);
      }
      const auto found = is_new ? in_cube.find(at) : in_cube.end();
      if (found == in_cube.end())
        continue;
      for (const std::size_t j : found->second)
        if (first[i] == i && square_of(x, points[j]) <= distance * distance)
          first[i] = j;
    }
    if (first[i] == i)
    {
      for (int d = 0; d < 3; ++d)
        at[d] = std::floor(x[d] / cube);
      in_cube[at].push_back(i);
    }
  }
  return first;
}
} // namespace sabot
