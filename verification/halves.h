#ifndef verification_halves_h
#define verification_halves_h

#include "sabot/bodies/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sabot
{
/** Positions by reference position, on a grid of a nanometer. */
inline std::map<std::array<long, 3>, Vec> positions(const Body &body)
{
  std::map<std::array<long, 3>, Vec> result;
  const NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    std::array<long, 3> key;
    for (int d = 0; d < 3; ++d)
      key[d] = std::lround(n.reference_position[i][d] * 1e9);
    result[key] = n.position[i];
  }
  return result;
}

/** Largest distance between nodes of the part and those of the whole [m]. */
inline double largest_difference(const Body &part, const Body &whole)
{
  const auto all = positions(whole);
  double worst = 0.;
  for (const auto &[key, x] : positions(part))
    worst = std::max(worst, norm(x - all.at(key)));
  return worst;
}
} // namespace sabot

#endif
