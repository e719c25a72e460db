// Bodies of a scene that stand in each other's place.
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace sabot
{
namespace
{
/** What counts as an overlap at all [m]. */
constexpr double seen_from_outside = 1e-9;

double smallest_extent(const Outline &outline)
{
  const Vec size = outline.high - outline.low;
  return std::min({size[0], size[1], size[2]});
}

/** A zone fills the place of the cells that its host has lost. */
bool is_zone_of(const Scene &scene, const int a, const int b)
{
  for (const CarvedZone &zone : scene.zones)
    if ((zone.zone == a && zone.host == b) ||
        (zone.zone == b && zone.host == a))
      return true;
  return false;
}
} // namespace

std::vector<Outline> take_outlines(const Scene &scene)
{
  std::vector<Outline> outlines;
  for (const auto &body : scene.bodies)
    outlines.push_back(std::exchange(body->outline, Outline()));
  return outlines;
}

void check_overlaps(const Scene &scene, const std::vector<Outline> &outlines)
{
  for (std::size_t i = 0; i < outlines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      if (is_zone_of(scene, i, j))
        continue;
      const Outline &one = outlines[i], &other = outlines[j];
      const Overlap overlap = deepest_overlap(one, other);
      const double size =
          std::min(smallest_extent(one), smallest_extent(other));
      if (overlap.depth <= 1e-6 * size + seen_from_outside ||
          overlap.depth <= one.chord_error() + other.chord_error())
        continue;
      const std::string &name = scene.bodies[i]->name;
      char text[200];
      std::snprintf(text, sizeof(text),
                    " overlap by %.6g mm at (%.6g, %.6g, %.6g) mm",
                    1e3 * overlap.depth, 1e3 * overlap.place[0],
                    1e3 * overlap.place[1], 1e3 * overlap.place[2]);
      throw InputError("Bodies/" + name + "/Center",
                       "bodies \"" + name + "\" and \"" +
                           scene.bodies[j]->name + "\"" + text +
                           "; move one of them apart");
    }
}
} // namespace sabot
