// Runs what a study lacks, then writes tables, charts and the report.
#include "sabot/study/study.h"

#include "sabot/base/hash.h"
#include "sabot/base/stop_signals.h"
#include "sabot/base/text.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/file_lock.h"
#include "sabot/output/file_tools.h"
#include "sabot/study/pictures.h"
#include "sabot/study/process_pool.h"
#include "sabot/study/results.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

/** What a run has said last: of what the study sets with the line of the study
    that does, not by the option that hands it on. */
std::string last_words(const StudyRun &run, const std::string &folder)
{
  const std::vector<std::string> lines = lines_of(folder + "/output.txt");
  std::string line = lines.empty() ? "" : lines.back();
  for (std::size_t i = 0; i < run.overrides.size(); ++i)
    line = replaced(std::move(line), "--set \"" + run.overrides[i] + "\"",
                    run.origins[i].value);
  return line;
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
  {
    command.words = {"mpirun", "--oversubscribe", "-np",
                     std::to_string(study.n_ranks)};
    // At SIGTERM an mpirun gives its ranks no more than a second for a
    // checkpoint; this one it passes on.
    command.stop_signal = SIGUSR1;
  }
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

/** Whether a run is as good as done: kept, unless asked for anew. */
struct RunState
{
  std::string status;
  bool is_of_other_build = false;
  bool is_kept = false;
};

RunState state_of(const StudyArguments &arguments, const StudyFile &study,
                  const StudyRun &run, const std::string &build)
{
  RunState state;
  const std::string folder = run_folder(arguments, run),
                    built = build_of(folder);
  state.status = read_outcome(folder, study.quantities).status;
  state.is_of_other_build = !built.empty() && built != build;
  state.is_kept = (state.status == "completed" ||
                   (state.status == "failed" && !arguments.retry)) &&
                  !(state.is_of_other_build && arguments.renew);
  return state;
}

/** When a run's result was written; no time where there is none. */
fs::file_time_type time_of_result(const std::string &folder)
{
  std::error_code error;
  const auto time = fs::last_write_time(folder + "/result.json", error);
  return error ? fs::file_time_type::min() : time;
}

/** What is to be started, and what is kept from before. */
struct Plan
{
  struct Item
  {
    const StudyRun *run;
    std::string folder;
    fs::file_time_type result_time; // when it was planned
    std::unique_ptr<FileLock> lock; // while it runs
    bool waits = false;             // another study has it
  };
  std::string build;
  std::vector<Item> items;     // to be started
  std::size_t n_different = 0; // two choices may give one scene
  std::size_t n_kept = 0, n_of_other_builds = 0;
};

Plan plan_runs(const StudyArguments &arguments, const StudyFile &study)
{
  Plan plan;
  std::set<std::string> seen;
  plan.build = build_of_program();
  for (const StudyRun &run : study.runs)
  {
    if (!seen.insert(run.key).second)
      continue;
    const RunState state = state_of(arguments, study, run, plan.build);
    plan.n_kept += state.is_kept;
    plan.n_of_other_builds += state.is_kept && state.is_of_other_build;
    const std::string folder = run_folder(arguments, run);
    if (!state.is_kept)
      plan.items.push_back(
          {&run, folder, time_of_result(folder), nullptr, false});
  }
  plan.n_different = seen.size();
  return plan;
}

/** Take the run of @p item, unless another study has it: then its result will
    be that of this study, too. */
Readiness prepare(const StudyArguments &arguments, const StudyFile &study,
                  const std::string &build, Plan::Item &item, Command &command)
{
  make_folder(item.folder);
  auto lock = std::make_unique<FileLock>(item.folder + "/study.lock");
  if (!lock->is_held())
  {
    if (!item.waits && !arguments.quiet)
      std::cout << item.run->key << ": waiting for another study that runs it ("
                << lock->holder() << ")" << std::endl;
    item.waits = true;
    return Readiness::later;
  }
  const RunState state = state_of(arguments, study, *item.run, build);
  const bool is_new = time_of_result(item.folder) != item.result_time;
  if (state.is_kept || (is_new && state.status == "failed"))
    return Readiness::never;
  write_text(item.folder + "/build.txt", build + "\n");
  if (state.status == "missing") // none, or damaged
    remove_file(item.folder + "/result.json");
  const bool resume =
      state.status != "failed" && !state.is_of_other_build &&
      !CheckpointFolder::list(item.folder + "/checkpoint").empty();
  command = command_for(study, *item.run, item.folder, resume);
  command.descriptor = lock->open_descriptor();
  item.lock = std::move(lock);
  return Readiness::now;
}

/** What to say of a run that ended. */
std::string report_of(const StudyFile &study, const Plan::Item &item,
                      const int code)
{
  std::string text = item.run->key;
  for (std::size_t p = 0; p < study.parameters.size(); ++p)
    text += (p == 0 ? ": " : ", ") + study.parameters[p].name + " " +
            study.parameters[p].values[item.run->choice[p]].label;
  if (code == 0)
    return text;
  // What a quiet run says stands in its result.
  const std::string said = last_words(*item.run, item.folder);
  return text + ": exit code " + std::to_string(code) + ": " +
         (said.empty() ? read_outcome(item.folder, study.quantities).reason
                       : said);
}

/** Run what is missing. @return whether nothing stopped it. */
bool complete_runs(const StudyArguments &arguments, const StudyFile &study)
{
  Plan plan = plan_runs(arguments, study);
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
  const auto say = [&](const std::string &text)
  {
    ++n_ended;
    if (!arguments.quiet)
      std::cout << "[" << n_ended << "/" << plan.items.size() << "] " << text
                << std::endl;
  };
  const auto turn = [&](const std::size_t number, Command &command)
  {
    Plan::Item &item = plan.items[number];
    const Readiness result =
        prepare(arguments, study, plan.build, item, command);
    if (result == Readiness::never)
      say(item.run->key + ": made by another study");
    return result;
  };
  const auto report = [&](const Ended &ended)
  {
    Plan::Item &item = plan.items[ended.command];
    item.lock.reset();
    say(report_of(study, item, ended.code));
  };
  return run_processes(plan.items.size(), n_processes, turn, report);
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
  listen_to_stop_signals();
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
      outcome.reason = last_words(run, folder);
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
