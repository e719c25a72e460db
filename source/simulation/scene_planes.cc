// Planes of symmetry that some bodies of a scene have and others do not, and
// zones that do not fly with their hosts.
#include "sabot/base/text.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sabot
{
namespace
{
std::string described(const SymmetryPlane &plane)
{
  return std::string(1, "xyz"[plane.axis]) +
         formatted(" = %.6g mm", 1e3 * plane.coordinate);
}

/** Whether both are one plane up to @p tolerance [m]. */
bool is_same(const SymmetryPlane &one, const SymmetryPlane &other,
             const double tolerance)
{
  return one.axis == other.axis &&
         std::abs(one.coordinate - other.coordinate) < tolerance;
}

/** Guided along the plane, it stays what it is on its side of it. */
bool is_guided_along(const SymmetryPlane &plane, const Body &body,
                     const BodyFacts &facts)
{
  return !facts.deforms && body.is_held() && !facts.moves_by_itself &&
         facts.velocity[plane.axis] == 0.;
}
} // namespace

std::vector<int> MotionDoubts::groups() const
{
  std::vector<int> group(facts.size());
  std::iota(group.begin(), group.end(), 0);
  const auto join = [&](const int a, const int b)
  {
    const int from = group[b], to = group[a];
    std::replace(group.begin(), group.end(), from, to);
  };
  for (const BodyPairs *const pairs : {&held_apart, &joined})
    for (const auto &[a, b] : *pairs)
      join(a, b);
  for (int a = 0; a < int(facts.size()); ++a)
    for (int b = a + 1; b < int(facts.size()); ++b)
      if (group[a] != group[b] && time_to_meeting(a, b))
        join(a, b);
  return group;
}

std::vector<std::string> MotionDoubts::forgotten_planes() const
{
  std::vector<std::string> warnings;
  const std::vector<int> group = groups();
  for (int a = 0; a < int(facts.size()); ++a)
    for (const SymmetryPlane &plane : scene.bodies[a]->planes_of_symmetry())
      for (int b = 0; b < int(facts.size()); ++b)
      {
        const Body &other = *scene.bodies[b];
        const double tolerance = 1e-3 * outlines[b].spacing();
        const auto planes = other.planes_of_symmetry();
        if (a == b || group[a] != group[b] || outlines[b].faces.empty() ||
            is_guided_along(plane, other, facts[b]) ||
            std::any_of(planes.begin(), planes.end(),
                        [&](const SymmetryPlane &p)
                        { return is_same(p, plane, tolerance); }))
          continue;
        // Heights on the side where the model is.
        const double side =
            outlines[a].low[plane.axis] + outlines[a].high[plane.axis] >
                    2. * plane.coordinate
                ? 1.
                : -1.;
        const double one = side *
                           (outlines[b].low[plane.axis] - plane.coordinate),
                     two = side *
                           (outlines[b].high[plane.axis] - plane.coordinate);
        const double low = std::min(one, two), high = std::max(one, two);
        if (low > tolerance)
          continue;
        const std::string text =
            "body \"" + name(b) + "\" " +
            (low > -tolerance    ? "ends on"
             : high <= tolerance ? "lies beyond"
                                 : "reaches across") +
            " the plane of symmetry " + described(plane) + " of body \"" +
            name(a) + "\", but is not cut there: " +
            (facts[b].deforms
                 ? "add the face to its symmetry faces, or model it whole on "
                   "one side"
                 : "a rigid body cannot be cut; guide it with a prescribed "
                   "motion, or model all bodies whole");
        if (std::find(warnings.begin(), warnings.end(), text) == warnings.end())
          warnings.push_back(text);
      }
  return warnings;
}

std::vector<std::string> MotionDoubts::zones_left_behind() const
{
  std::vector<std::string> warnings;
  for (const CarvedZone &zone : scene.zones)
    if (facts[zone.zone].velocity != facts[zone.host].velocity)
      warnings.push_back("body \"" + name(zone.zone) + "\" is carved from \"" +
                         name(zone.host) +
                         "\" but starts with another velocity; give both the "
                         "same initial velocity");
  return warnings;
}
} // namespace sabot
