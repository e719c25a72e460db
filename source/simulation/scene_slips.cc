// Values of entries that are possible but can hardly be meant.
#include "sabot/base/text.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
class Slips
{
public:
  explicit Slips(const ParameterFile &file) : file(file) {}

  /** Of an entry with a length, or the first of several; nothing where it is
      not set, or is a word. */
  std::optional<double> number(const std::string &path) const
  {
    const std::vector<std::string> parts = split(file.value(path, ""), ',');
    return parts.empty() ? std::nullopt : read_quantity(parts[0]);
  }

  void say(const std::string &path, const std::string &what)
  {
    said.push_back(file.origin(path) + ": " + path + ": " + what);
  }

  void look_at_angle(const std::string &body)
  {
    const std::string path = "Bodies/" + body + "/Rotation angle",
                      text = trim(file.value(path, "0"));
    const double angle = read_quantity(text).value_or(0.);
    const bool has_unit =
        !text.empty() && std::isalpha(static_cast<unsigned char>(text.back()));
    if (!has_unit && std::abs(angle) > 2. * M_PI)
      say(path, text + " is " + formatted("%.3g turns", angle / (2. * M_PI)) +
                    ": is the unit deg missing (a number alone is in rad)?");
  }

  /** What belongs to a rotation that is none. */
  void look_at_rotation(const std::string &body)
  {
    const std::string start = "Bodies/" + body + "/";
    if (file.is_set(start + "Rotation angle") ||
        file.is_set(start + "Yaw pitch roll"))
      return;
    for (const std::string entry : {"Rotation axis", "Rotation center"})
      if (file.is_chosen(start + entry))
        say(start + entry, "has no effect without \"Rotation angle\"");
  }

  /** As many cells stand along a nose as along half a ball. */
  void look_at_nose(const std::string &body)
  {
    constexpr double most = 3.5; // radii, an ogive of caliber 3.3
    const std::string start = "Bodies/" + body + "/",
                      path = start + "Nose length";
    const std::optional<double> length = number(path),
                                radius = number(start + "Radius");
    if (length && radius && *length > most * *radius)
      say(path, formatted("is %.3g times the radius", *length / *radius) +
                    ": its cells are as much longer than across, whatever the "
                    "\"Cell size\"; a mesh from a file may have more of them");
  }

  void look_at_grading(const std::string &body)
  {
    const std::string path = "Bodies/" + body + "/Coarsest cell size";
    const std::optional<double> fine = number("Bodies/" + body + "/Cell size"),
                                coarse = number(path);
    if (fine && coarse && *coarse < *fine * (1. - 1e-9))
      say(path, file.value(path, "") + " is finer than the \"Cell size\" of " +
                    formatted("%.4g mm", 1e3 * *fine) +
                    "; cells grow from that to this");
    const std::string start = "Bodies/" + body + "/",
                      geometry = file.value(start + "Geometry", "box");
    if (geometry == "box")
      look_at_grading_of_box(start, body);
    else if (geometry == "cylinder" && coarse &&
             number(start + "Growth ratio").value_or(1.) == 1.)
      say(path, "has no effect: rings of cells grow by the \"Growth ratio\", "
                "which is 1; give one above, for example 1.15");
  }

  /** What is to grow away from a fine part that there is not. */
  void look_at_grading_of_box(const std::string &start, const std::string &body)
  {
    const bool is_refined =
        number(start + "Refined zone size").value_or(0.) > 0.;
    if (!is_refined && file.is_chosen(start + "Refined zone center"))
      say(start + "Refined zone center",
          "has no effect without \"Refined zone size\"");
    if (is_refined || is_meshed_around_zone(body))
      return;
    for (const std::string entry : {"Coarsest cell size", "Growth ratio"})
      if (file.is_chosen(start + entry) &&
          file.value(start + entry, "none") != "none")
        return say(start + entry,
                   "has no effect: cells grow away from the fine part of a "
                   "box, and this has none; give a \"Refined zone size\", or "
                   "carve a fixed zone, a box, from it");
  }

  /** Whether a listed zone is a box of its own lattice in this box. */
  bool is_meshed_around_zone(const std::string &body) const
  {
    for (const std::string &name :
         split_names(file.value("List of bodies", "")))
    {
      const std::string start = "Bodies/" + name + "/";
      if (file.value(start + "Carve from", "") == body &&
          file.value(start + "Geometry", "box") == "box" &&
          file.value(start + "Zone", "fixed") == "fixed")
        return true;
    }
    return false;
  }

  /** The cut faces of a half or quarter want planes of symmetry. */
  void look_at_sector(const std::string &body)
  {
    const std::string start = "Bodies/" + body + "/",
                      sector = file.value(start + "Sector", "full");
    if (sector == "full")
      return;
    const std::size_t needed = sector == "half" ? 1 : 2,
                      n = split_names(file.value(start + "Symmetry faces", ""))
                              .size();
    if (n < needed)
      say(start + "Sector",
          sector + " leaves " + (n == 0 ? "its cut faces" : "a cut face") +
              " free; name " + (needed == 1 ? "it" : "both") +
              " in \"Symmetry faces\", or take the full body");
  }

  void look_at_size(const std::string &body, const Outline &outline)
  {
    for (const std::string entry : {"Cell size", "Nodal spacing"})
    {
      const std::string path = "Bodies/" + body + "/" + entry;
      const std::optional<double> size = number(path);
      const Vec extent = outline.high - outline.low;
      const double least = std::min({extent[0], extent[1], extent[2]});
      if (size && split(file.value(path, ""), ',').size() == 1 && least > 0. &&
          *size > 1.1 * least)
        say(path, file.value(path, "") + " is more than the body is across, " +
                      formatted("%.4g mm", 1e3 * least) +
                      ": what deforms takes several over its least extent");
    }
  }

  /** What belongs to driven faces, and these without it. */
  void look_at_drive(const std::string &body)
  {
    const std::string start = "Bodies/" + body + "/",
                      faces = start + "Driven faces",
                      velocity = start + "Prescribed velocity";
    if (split_names(file.value(faces, "")).empty())
    {
      for (const std::string &path :
           {velocity, start + "Prescribed components"})
        if (file.is_chosen(path))
          say(path, "has no effect without \"Driven faces\"");
    }
    else if (!file.is_set(velocity))
      say(faces, "no \"Prescribed velocity\" is set: they stand still");
  }

  /** Half a body flies away from its other half. */
  void look_at_planes(const Body &body)
  {
    const std::string path = "Bodies/" + body.name + "/Initial velocity";
    const BodyFacts facts = body.facts();
    for (const SymmetryPlane &plane : body.planes_of_symmetry())
      if (facts.velocity[plane.axis] != 0.)
        say(path, "goes across the body's plane of symmetry " +
                      std::string(1, "xyz"[plane.axis]) +
                      ": nodes on it stay, the others fly on");
  }

  void look_at_output(const std::string &name, const double end_time)
  {
    const std::string path = "Outputs/" + name + "/Interval";
    const std::optional<double> interval = number(path);
    if (interval && *interval > end_time)
      say(path, file.value(path, "") +
                    " is longer than the run (\"End time\" " +
                    formatted("%.4g us", 1e6 * end_time) +
                    "): only start and end are written");
  }

  std::vector<std::string> said;

private:
  const ParameterFile &file;
};
} // namespace

std::vector<std::string> slips_of_entries(const ParameterFile &file,
                                          const std::vector<Outline> &outlines,
                                          const Scene &scene)
{
  Slips slips(file);
  for (const auto &body : scene.bodies)
  {
    slips.look_at_angle(body->name);
    slips.look_at_rotation(body->name);
    slips.look_at_nose(body->name);
    slips.look_at_grading(body->name);
    if (body->facts().deforms)
    {
      slips.look_at_sector(body->name);
      slips.look_at_size(body->name, outlines[body->id]);
    }
    slips.look_at_drive(body->name);
    slips.look_at_planes(*body);
  }
  for (const std::string &name : split_names(file.value("List of outputs", "")))
    slips.look_at_output(name, scene.settings.end_time);
  return slips.said;
}
} // namespace sabot
