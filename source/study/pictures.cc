// Asks sabot-charts for pictures of charts and sections.
#include "sabot/study/pictures.h"

#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/output/file_tools.h"
#include "sabot/study/process_pool.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

/** Values of a comma-separated list of quantities [SI]. */
std::vector<double> read_option(const std::string &option,
                                const std::string &text,
                                const Dimension dimension,
                                const unsigned int n_min,
                                const unsigned int n_max)
{
  const Pattern pattern = quantities(dimension, n_min, n_max);
  if (!pattern.match(text))
    throw InputError("", option + ": \"" + text + "\" should be " +
                             pattern.description());
  Parameters prm;
  prm.declare_entry("values", text, pattern, "");
  return get_quantities(prm, "values");
}

std::string title_of(const std::string &folder)
{
  std::ifstream file(folder + "/result.json");
  const nlohmann::json result = nlohmann::json::parse(file, nullptr, false);
  const bool has_title = result.is_object() && result.contains("title") &&
                         result["title"].is_string();
  return file && has_title ? result["title"].get<std::string>() : "";
}

/** Times of the frames that a run has left, ascending [s]. */
std::vector<double> frame_times(const std::string &folder)
{
  const std::string key = "<DataSet timestep=\"";
  std::vector<double> times;
  for (const std::string &line : lines_of(folder + "/sabot.pvd"))
    if (const std::size_t at = line.find(key); at != std::string::npos)
    {
      const double time = std::atof(line.c_str() + at + key.size());
      if (times.empty() || times.back() != time)
        times.push_back(time);
    }
  return times;
}

/** InputError for a time that no frame stands for: farther from the nearest
    than half of the largest distance of two. */
void check_times(const std::vector<double> &wanted,
                 const std::vector<double> &frames)
{
  if (frames.empty())
    return; // the program that draws says so
  double reach = 1e-6 * frames.back();
  for (std::size_t f = 1; f < frames.size(); ++f)
    reach = std::max(reach, 0.5001 * (frames[f] - frames[f - 1]));
  for (const double time : wanted)
    if (time > frames.back() + reach || time < frames.front() - reach)
      throw InputError("", "--time: at " + formatted("%.6g", 1e6 * time) +
                               " us there is nothing to show: the run has "
                               "frames from " +
                               formatted("%.6g", 1e6 * frames.front()) +
                               " to " + formatted("%.6g", 1e6 * frames.back()) +
                               " us");
}

/** What the program that draws has said, on one line. */
std::string all_lines(const std::string &file)
{
  std::string text;
  for (const std::string &line : lines_of(file))
    text += (text.empty() ? "" : "; ") +
            (line.compare(0, 7, "error: ") == 0 ? line.substr(7) : line);
  return text;
}
} // namespace

nlohmann::ordered_json section_of(const PictureArguments &arguments)
{
  nlohmann::ordered_json section;
  section["kind"] = "section";
  section["folder"] = fs::absolute(arguments.folder).string();
  section["file"] =
      fs::absolute(arguments.file.empty() ? arguments.folder + "/section.png"
                                          : arguments.file)
          .string();
  if (!arguments.field.empty())
    section["field"] = arguments.field;
  section["title"] =
      arguments.title.empty() ? title_of(arguments.folder) : arguments.title;
  constexpr unsigned int most_panels = 12;
  if (!arguments.times.empty())
    section["times"] =
        read_option("--time", arguments.times, Dimension::time, 1, most_panels);
  if (!arguments.normal.empty())
    section["normal"] = arguments.normal;
  if (!arguments.position.empty())
    section["position"] =
        read_option("--at", arguments.position, Dimension::length, 1, 1)[0];
  if (!arguments.range.empty())
    section["range"] =
        read_option("--range", arguments.range, Dimension::none, 2, 2);
  if (!arguments.window.empty())
    section["window"] =
        read_option("--window", arguments.window, Dimension::length, 4, 4);
  for (const char *const pair : {"range", "window"})
    if (section.contains(pair))
      for (std::size_t i = 0; i + 1 < section[pair].size(); i += 2)
        if (!(section[pair][i] < section[pair][i + 1]))
          throw InputError("", "--" + std::string(pair) +
                                   ": the first of two limits must be the "
                                   "lower one");
  return section;
}

std::string draw_pictures(const nlohmann::ordered_json &drawings,
                          const std::string &folder)
{
  const std::string program =
      fs::path(own_program()).parent_path().string() + "/sabot-charts";
  Command command;
  if (!fs::exists(program))
    return "\"" + program + "\" is missing; scripts/build.sh release builds it";
  if (std::getenv("DISPLAY") == nullptr)
  {
    if (!is_on_path("xvfb-run"))
      return "there is neither a DISPLAY nor xvfb-run (Debian packages xvfb "
             "and xauth)";
    command.words = {"xvfb-run", "-a"};
  }
  const std::string file = folder + "/drawings.json";
  write_text(file, drawings.dump(1) + "\n");
  command.words.insert(command.words.end(), {program, file, folder});
  command.log = folder + "/drawings.txt";
  int code = 0;
  const auto at_once = [&](std::size_t, Command &next)
  {
    next = command;
    return Readiness::now;
  };
  const bool started = run_processes(
      1, 1, at_once, [&](const Ended &ended) { code = ended.code; });
  if (!started)
    return "a signal asked to stop";
  if (code == 0)
    return "";
  const std::string said = all_lines(command.log);
  return said.empty()
             ? "sabot-charts ended with exit code " + std::to_string(code)
             : said;
}

ExitCode draw_picture(const PictureArguments &arguments)
{
  const nlohmann::ordered_json section = section_of(arguments);
  if (!fs::exists(arguments.folder + "/sabot.pvd"))
    throw InputError(
        "", "\"" + arguments.folder +
                "\" holds no fields (sabot.pvd) of a run" +
                (fs::exists(arguments.folder + "/parameters.prm")
                     ? ": its scene lists no output of type VTU; add one and "
                       "run it again"
                     : ""));
  if (section.contains("times"))
    check_times(section["times"], frame_times(arguments.folder));
  const std::string file = section["file"];
  const std::string folder = fs::path(file).parent_path().string();
  make_folder(folder);
  const std::string problem =
      draw_pictures(nlohmann::ordered_json::array({section}), folder);
  for (const char *const left : {"/drawings.json", "/drawings.txt"})
    fs::remove(folder + left);
  if (!problem.empty())
    throw IOError("no picture: " + problem);
  std::cout << file << std::endl;
  return ExitCode::done;
}
} // namespace sabot
