// What holds or loads a face of a host, where its zone of particles begins.
#include "sabot/base/text.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** A side of the bounds of a host: its axis and whether it is the upper. */
using Side = std::pair<int, bool>;

class ZoneSlips
{
public:
  ZoneSlips(const ParameterFile &file, const Scene &scene,
            const CarvedZone &zone)
      : file(file), zone(zone), host_name(scene.bodies[zone.host]->name),
        zone_name(scene.bodies[zone.zone]->name),
        loads(split_names(file.value("List of loads", "")))
  {
  }

  void look_at_faces(const std::string &entry, const std::string &what,
                     const std::string &advice)
  {
    const std::string path = "Bodies/" + host_name + "/" + entry,
                      own = file.value("Bodies/" + zone_name + "/" + entry, "");
    for (const std::string &word : split_names(file.value(path, "")))
      if (is_reached(word) && !lists(own, word))
        say(path, "\"" + word + "\" does not " + what + advice);
  }

  void look_at_loads()
  {
    for (const std::string &load : loads)
    {
      const std::string start = "Loads/" + load + "/",
                        type = file.value(start + "Type", "gravity");
      if (type == "gravity")
        look_at_gravity(start + "Bodies");
      else if (trim(file.value(start + "Body", "")) == host_name)
        for (const std::string &word :
             split_names(file.value(start + "Faces", "")))
          if (is_reached(word) && !is_loaded(type, word))
            say(start + "Faces",
                "\"" + word + "\" of \"" + host_name + "\" does not " +
                    (type == "prescribed motion" ? "move" : "load") +
                    particles() + "; add a load of this type on \"" +
                    zone_name + "\"");
    }
  }

  std::string particles() const
  {
    return " the particles of its zone \"" + zone_name +
           "\", which reaches that face";
  }

  std::vector<std::string> said;

private:
  void say(const std::string &path, const std::string &what)
  {
    said.push_back(file.origin(path) + ": " + path + ": " + what);
  }

  /** The side that a name or a plane means; nothing for other faces. */
  std::optional<Side> side_of(const std::string &word) const
  {
    const auto is_axis = [](const char c) { return c >= 'x' && c <= 'z'; };
    if (word.size() == 2 && (word[0] == '-' || word[0] == '+') &&
        is_axis(word[1]))
      return Side(word[1] - 'x', word[0] == '+');
    if (word == "lower" || word == "upper")
      return Side(file.value("Bodies/" + host_name + "/Axis", "z").back() - 'x',
                  word == "upper");
    const std::size_t equal = word.find('=');
    if (equal == std::string::npos || !is_axis(word[0]) || !zone.turn.is_none())
      return std::nullopt;
    const int axis = word[0] - 'x';
    const auto place = read_quantity(trim(word.substr(equal + 1)));
    for (const bool is_upper : {false, true})
      if (place && is_near(axis, *place, bound(axis, is_upper)))
        return Side(axis, is_upper);
    return std::nullopt;
  }

  double bound(const int axis, const bool is_upper) const
  {
    return (is_upper ? zone.host_high : zone.host_low)[axis];
  }

  bool is_near(const int axis, const double one, const double other) const
  {
    return std::abs(one - other) <
           1e-6 * (zone.host_high[axis] - zone.host_low[axis]);
  }

  bool is_reached(const std::string &word) const
  {
    const std::optional<Side> side = side_of(word);
    if (!side)
      return false;
    const auto [axis, is_upper] = *side;
    const double sign = is_upper ? 1. : -1.,
                 end = zone.shape.center[axis] +
                       0.5 * sign * zone.shape.size[axis],
                 beyond = sign * (end - bound(axis, is_upper));
    return beyond > 0. || is_near(axis, end, bound(axis, is_upper));
  }

  /** Whether a list of faces has the side that @p word means. */
  bool lists(const std::string &list, const std::string &word) const
  {
    const std::vector<std::string> words = split_names(list);
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string &other) {
                         return other == word ||
                                side_of(other) == side_of(word);
                       });
  }

  bool is_loaded(const std::string &type, const std::string &word) const
  {
    return std::any_of(loads.begin(), loads.end(),
                       [&](const std::string &load)
                       {
                         const std::string start = "Loads/" + load + "/";
                         return file.value(start + "Type", "gravity") == type &&
                                trim(file.value(start + "Body", "")) ==
                                    zone_name &&
                                lists(file.value(start + "Faces", ""), word);
                       });
  }

  void look_at_gravity(const std::string &path)
  {
    const std::vector<std::string> bodies =
        split_names(file.value(path, "all"));
    const auto acts_on = [&](const std::string &body)
    { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); };
    if (acts_on(host_name) && !acts_on(zone_name))
      say(path, "names \"" + host_name + "\" but not its zone \"" + zone_name +
                    "\", which does not fall with it; name both");
  }

  const ParameterFile &file;
  const CarvedZone &zone;
  const std::string host_name, zone_name;
  const std::vector<std::string> loads;
};
} // namespace

std::vector<std::string> slips_of_zones(const ParameterFile &file,
                                        const Scene &scene)
{
  std::vector<std::string> said;
  for (const CarvedZone &zone : scene.zones)
  {
    ZoneSlips slips(file, scene, zone);
    slips.look_at_faces("Clamped faces", "hold",
                        slips.particles() + "; list it there, too");
    slips.look_at_faces("Driven faces", "move",
                        slips.particles() +
                            "; drive both by loads, or keep the zone away");
    slips.look_at_loads();
    said.insert(said.end(), slips.said.begin(), slips.said.end());
  }
  return said;
}
} // namespace sabot
