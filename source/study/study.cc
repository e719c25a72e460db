// Runs what a study lacks, then writes tables, charts and the report.
#include "sabot/study/study.h"

#include "sabot/base/hash.h"
#include "sabot/base/text.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/file_tools.h"
#include "sabot/study/pictures.h"
#include "sabot/study/process_pool.h"
#include "sabot/study/results.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

std::string last_line(const std::string &file)
{
  const std::vector<std::string> lines = lines_of(file);
  return lines.empty() ? "" : lines.back();
}

std::string run_folder(const StudyArguments &arguments, const StudyRun &run)
{
  return (arguments.runs.empty() ? arguments.folder + "/runs"
                                 : arguments.runs) +
         "/" + run.key;
}

Command command_for(const StudyFile &study, const StudyRun &run,
                    const std::string &folder, const bool resume)
{
  Command command;
  if (study.n_ranks > 1)
    command.words = {"mpirun", "--oversubscribe", "-np",
                     std::to_string(study.n_ranks)};
  command.words.push_back(own_program());
  if (resume)
    command.words.insert(command.words.end(), {"resume", folder});
  else
  {
    // What a study keeps are results; checkpoints of all its runs at their ends
    // would take more room than these.
    command.words.insert(command.words.end(),
                         {"run", run.scene, "-o", folder, "--overwrite",
                          "--set", "Checkpoint at the end=false"});
    for (const std::string &text : run.overrides)
      command.words.insert(command.words.end(), {"--set", text});
  }
  command.words.push_back("--quiet");
  command.log = folder + "/output.txt";
  return command;
}

void list_runs(const StudyArguments &arguments, const StudyFile &study)
{
  for (const StudyRun &run : study.runs)
  {
    std::cout
        << run.key << " "
        << read_outcome(run_folder(arguments, run), study.quantities).status
        << ": " << run.scene;
    for (const std::string &text : run.overrides)
      std::cout << " --set \"" << text << "\"";
    std::cout << "\n";
  }
}

/** What tells builds of the program apart: its version may stay the same. */
std::string build_of_program()
{
  const std::string program = own_program();
  return sha256_of_file(program, fs::file_size(program)).substr(0, 16);
}

/** The build that made a run; empty when it is not known. */
std::string build_of(const std::string &folder)
{
  std::ifstream file(folder + "/build.txt");
  std::string build;
  std::getline(file, build);
  return build;
}

/** What is to be started, and what is kept from before. */
struct Plan
{
  std::vector<Command> commands;
  std::vector<const StudyRun *> started; // per command
  std::size_t n_different = 0;           // two choices may give one scene
  std::size_t n_kept = 0, n_of_other_builds = 0;
};

Plan plan_runs(const StudyArguments &arguments, const StudyFile &study)
{
  Plan plan;
  std::set<std::string> seen;
  const std::string build = build_of_program();
  for (const StudyRun &run : study.runs)
  {
    if (!seen.insert(run.key).second)
      continue;
    const std::string folder = run_folder(arguments, run);
    const std::string status = read_outcome(folder, study.quantities).status;
    const std::string built = build_of(folder);
    const bool is_of_other_build = !built.empty() && built != build;
    if ((status == "completed" || (status == "failed" && !arguments.retry)) &&
        !(is_of_other_build && arguments.renew))
    {
      ++plan.n_kept;
      plan.n_of_other_builds += is_of_other_build;
      continue;
    }
    make_folder(folder);
    write_text(folder + "/build.txt", build + "\n");
    const bool resume = status != "failed" && !is_of_other_build &&
                        !CheckpointFolder::list(folder + "/checkpoint").empty();
    plan.commands.push_back(command_for(study, run, folder, resume));
    plan.started.push_back(&run);
  }
  plan.n_different = seen.size();
  return plan;
}

/** Run what is missing. @return whether nothing stopped it. */
bool complete_runs(const StudyArguments &arguments, const StudyFile &study)
{
  const Plan plan = plan_runs(arguments, study);
  const unsigned int n_processes =
      arguments.n_processes > 0 ? arguments.n_processes : study.n_processes;
  if (!arguments.quiet)
    std::cout << plan.n_different << " runs, " << plan.n_kept
              << " of them kept from before, " << n_processes << " at a time"
              << std::endl;
  if (plan.n_of_other_builds > 0)
    std::cerr << "warning: " << plan.n_of_other_builds
              << " of the kept runs were made by another build of the program; "
                 "--renew runs them again"
              << std::endl;
  std::size_t n_ended = 0;
  const auto report = [&](const Ended &ended)
  {
    const StudyRun &run = *plan.started[ended.command];
    if (arguments.quiet)
      return;
    std::cout << "[" << ++n_ended << "/" << plan.commands.size() << "] "
              << run.key;
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      std::cout << (p == 0 ? ": " : ", ") << study.parameters[p].name << " "
                << study.parameters[p].values[run.choice[p]].label;
    if (ended.code != 0)
    {
      // What a quiet run says stands in its result.
      const std::string said = last_line(plan.commands[ended.command].log);
      std::cout << ": exit code " << ended.code << ": "
                << (said.empty() ? read_outcome(run_folder(arguments, run),
                                                study.quantities)
                                       .reason
                                 : said);
    }
    std::cout << std::endl;
  };
  return run_processes(plan.commands, n_processes, report);
}

/** Charts, and sections through those runs that have fields and no picture of
    them yet, as PNG files. @return what went wrong, in words. */
std::string draw_all(const StudyArguments &arguments,
                     const std::vector<Chart> &charts, StudyResults &results)
{
  const StudyFile &study = results.study;
  nlohmann::ordered_json drawings = nlohmann::ordered_json::array();
  for (const Chart &chart : charts)
    drawings.push_back(to_json(chart));
  std::set<std::string> seen;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    PictureArguments picture;
    picture.folder = run_folder(arguments, study.runs[run]);
    picture.field = study.picture_field;
    picture.times = study.picture_times;
    picture.title = study.title + ": " + results.label(run);
    const std::string fields = picture.folder + "/sabot.pvd";
    if (!study.has_pictures || results.outcomes[run].status == "missing" ||
        !fs::exists(fields))
      continue;
    // Other settings make another file.
    picture.file = picture.folder + "/section-" +
                   sha256(section_of(picture).dump()).substr(0, 8) + ".png";
    results.outcomes[run].picture = picture.file;
    if (seen.insert(picture.file).second &&
        (!fs::exists(picture.file) ||
         fs::last_write_time(picture.file) < fs::last_write_time(fields)))
      drawings.push_back(section_of(picture));
  }
  const std::string folder = arguments.folder + "/charts";
  make_folder(folder);
  const std::string problem = draw_pictures(drawings, folder);
  return problem.empty() ? "" : "no PNG pictures: " + problem;
}
} // namespace

ExitCode run_study(const StudyArguments &arguments)
{
  const StudyFile study(arguments.file, arguments.overrides);
  if (arguments.list)
  {
    list_runs(arguments, study);
    return ExitCode::done;
  }
  make_folder(arguments.folder);
  const bool all_started = complete_runs(arguments, study);

  std::vector<StudyOutcome> outcomes;
  std::size_t n_complete = 0;
  for (const StudyRun &run : study.runs)
  {
    const std::string folder = run_folder(arguments, run);
    StudyOutcome outcome = read_outcome(folder, study.quantities);
    if (outcome.status == "missing" && fs::exists(folder + "/output.txt"))
    {
      outcome.status = "failed";
      outcome.reason = last_line(folder + "/output.txt");
    }
    n_complete += outcome.is_complete();
    outcomes.push_back(outcome);
  }
  StudyResults results(study, outcomes);
  const std::vector<Chart> charts = results.charts();
  write_csv(results, arguments.folder + "/study.csv");
  write_hdf5(results, arguments.folder + "/study.h5");
  const std::string problem =
      all_started ? draw_all(arguments, charts, results) : "";
  write_report(results, charts, arguments.folder + "/report.html");
  if (!problem.empty())
    std::cerr << "warning: " << problem << std::endl;
  if (!arguments.quiet)
    std::cout << n_complete << " of " << study.runs.size()
              << " runs complete; see " << arguments.folder << "/report.html"
              << std::endl;
  return !all_started                      ? ExitCode::interrupted
         : n_complete == study.runs.size() ? ExitCode::done
                                           : ExitCode::physics_failed;
}
} // namespace sabot
