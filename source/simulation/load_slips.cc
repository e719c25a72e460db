// Loads that do nothing, or act where the run does not get.
#include "sabot/base/text.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
class LoadSlips
{
public:
  LoadSlips(const ParameterFile &file, const Scene &scene)
      : file(file), scene(scene)
  {
  }

  void look_at(const std::string &load)
  {
    const std::string start = "Loads/" + load + "/",
                      type = file.value(start + "Type", "gravity");
    if (type == "pressure")
      look_at_size(start, "Pressure", "it does nothing");
    else if (type == "traction")
      look_at_size(start, "Traction", "it does nothing");
    else if (type == "gravity" && file.is_set(start + "Acceleration"))
      look_at_size(start, "Acceleration", "it does nothing");
    else if (type == "prescribed motion" &&
             !file.is_set(start + "Angular velocity") &&
             !file.is_set(start + "Velocity"))
      say(start + "Type", "no \"Velocity\" is set: what it moves stands still");
    if (file.value(start + "Course", "constant") == "table")
      look_at_table(start);
  }

  std::vector<std::string> said;

private:
  void say(const std::string &path, const std::string &what)
  {
    said.push_back(file.origin(path) + ": " + path + ": " + what);
  }

  /** Of the numbers of an entry; none where it is not set. */
  std::vector<double> numbers(const std::string &path) const
  {
    std::vector<double> all;
    if (file.is_set(path))
      for (const std::string &item : split(file.value(path, ""), ','))
        all.push_back(read_quantity(trim(item)).value_or(0.));
    return all;
  }

  void look_at_size(const std::string &start, const std::string &entry,
                    const std::string &what)
  {
    double largest = 0.;
    for (const double value : numbers(start + entry))
      largest = std::max(largest, std::abs(value));
    if (!file.is_set(start + entry))
      say(start + "Type", "no \"" + entry + "\" is set: " + what);
    else if (largest == 0.)
      say(start + entry, "is 0: " + what);
    if (entry != "Acceleration" && largest > 0.)
      look_at_stress(start, entry, largest);
  }

  /** No solid of the scene bears as much as its modulus. */
  void look_at_stress(const std::string &start, const std::string &entry,
                      const double largest)
  {
    const std::string name = trim(file.value(start + "Body", ""));
    for (const auto &body : scene.bodies)
      if (body->name == name && body->facts().material != nullptr)
      {
        const Material &material = *body->facts().material;
        const double c = material.sound_speed(),
                     modulus = material.density() * c * c;
        if (largest > modulus)
          say(start + entry,
              file.value(start + entry, "") + " is " +
                  formatted("%.3g times ", largest / modulus) +
                  "the modulus of \"" + name +
                  "\": is a unit wrong (a number alone is in Pa)?");
      }
  }

  void look_at_table(const std::string &start)
  {
    const std::vector<double> times = numbers(start + "Times"),
                              factors = numbers(start + "Factors");
    const double end = scene.settings.end_time;
    if (times.empty() && factors.empty())
      say(start + "Course", "has no \"Times\" and \"Factors\": it is constant");
    else if (std::all_of(factors.begin(), factors.end(),
                         [](const double f) { return f == 0.; }))
      say(start + "Factors", "are all 0: it does nothing");
    else if (times.size() > 1 && times[0] >= end)
      say(start + "Times", "begin after the end time of " +
                               formatted("%.4g us", 1e6 * end) +
                               ": is a unit missing (a number alone is in s)?");
    else if (times.size() > 1 && times[0] <= 0. &&
             0.01 * (times[1] - times[0]) > end - times[0])
      say(start + "Times",
          "the run ends after " + formatted("%.4g us", 1e6 * end) + ", " +
              formatted("%.2g %%", 100. * end / (times[1] - times[0])) +
              " of the first stretch of the table: is a unit missing (a number "
              "alone is in s)?");
  }

  const ParameterFile &file;
  const Scene &scene;
};
} // namespace

std::vector<std::string> slips_of_loads(const ParameterFile &file,
                                        const Scene &scene)
{
  LoadSlips slips(file, scene);
  for (const std::string &name : split_names(file.value("List of loads", "")))
    slips.look_at(name);
  return slips.said;
}
} // namespace sabot
