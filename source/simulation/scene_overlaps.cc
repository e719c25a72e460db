// Bodies of a scene that stand in each other's place.
#include "sabot/simulation/body_assembly.h"

#include <algorithm>
#include <limits>
#include <set>

namespace sabot
{
namespace
{
constexpr double far = std::numeric_limits<double>::max();
/** What counts as an overlap at all [m]. */
constexpr double seen_from_outside = 1e-9;

/** Bodies overlap when a node of one lies deep inside the other's shape; for
    the boxes and cylinders of a scene their bounding boxes tell enough, but
    for a zone and the body that it was carved from, and for what is tied. */
struct Bounds
{
  double low[3] = {far, far, far}, high[3] = {-far, -far, -far};

  explicit Bounds(const Body &body)
  {
    for (const auto &p : body.partition_points())
      for (int d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], p[d]);
        high[d] = std::max(high[d], p[d]);
      }
  }
};

using Pairs = std::set<std::pair<std::string, std::string>>;

void add(Pairs &pairs, const std::string &a, const std::string &b)
{
  pairs.insert({a, b});
  pairs.insert({b, a});
}

/** Bodies whose boxes may overlap. */
Pairs excused_pairs(const Scene &scene, const ParameterFile &file)
{
  Pairs excused;
  for (const CarvedZone &zone : scene.zones)
    add(excused, scene.bodies[zone.zone]->name, scene.bodies[zone.host]->name);
  // Boxes around two sides of a curved tie overlap.
  for (const std::string &name :
       split_names(file.value("List of couplings", "")))
  {
    const std::string path = "Couplings/" + name;
    const std::string follower = file.value(path + "/Follower", ""),
                      leader = file.value(path + "/Leader", "");
    const auto is_box = [&](const std::string &body)
    {
      const auto *const shape = Registry<BodyShape>::find(
          file.value("Bodies/" + body + "/Geometry", "box"));
      return shape != nullptr && shape->make()->fills_bounds();
    };
    if (!follower.empty() && !(is_box(follower) && is_box(leader)))
      add(excused, follower, leader);
  }
  return excused;
}
} // namespace

void check_overlaps(const Scene &scene, const ParameterFile &file)
{
  const Pairs excused = excused_pairs(scene, file);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      const Body &one = *scene.bodies[i], &other = *scene.bodies[j];
      if (excused.count({one.name, other.name}) > 0)
        continue;
      const Bounds a(one), b(other);
      double overlap = far, size = far;
      for (int d = 0; d < 3; ++d)
      {
        overlap = std::min(overlap, std::min(a.high[d], b.high[d]) -
                                        std::max(a.low[d], b.low[d]));
        size = std::min({size, a.high[d] - a.low[d], b.high[d] - b.low[d]});
      }
      if (overlap > 1e-6 * size + seen_from_outside)
        throw InputError("Bodies/" + one.name + "/Center",
                         "bodies \"" + one.name + "\" and \"" + other.name +
                             "\" overlap by " + std::to_string(overlap * 1e3) +
                             " mm; move one of them apart");
    }
}
} // namespace sabot
