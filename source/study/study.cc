#include "sabot/study/study.h"

#include "sabot/output/checkpoint.h"
#include "sabot/output/file_tools.h"
#include "sabot/study/process_pool.h"
#include "sabot/study/results.h"

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
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (!line.empty())
      last = line;
  return last;
}

std::string run_folder(const StudyArguments &arguments, const StudyRun &run)
{
  return arguments.folder + "/runs/" + run.key;
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
    command.words.insert(command.words.end(), {"run", run.scene, "-o", folder});
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

/** Run what is missing. @return whether nothing stopped it. */
bool complete_runs(const StudyArguments &arguments, const StudyFile &study)
{
  std::vector<Command> commands;
  std::vector<const StudyRun *> started;
  std::set<std::string> seen;
  std::size_t n_kept = 0;
  for (const StudyRun &run : study.runs)
  {
    if (!seen.insert(run.key).second)
      continue; // two choices give the same scene
    const std::string folder = run_folder(arguments, run);
    const std::string status = read_outcome(folder, study.quantities).status;
    if (status == "completed" || (status == "failed" && !arguments.retry))
    {
      ++n_kept;
      continue;
    }
    make_folder(folder);
    const bool resume = status != "failed" &&
                        !CheckpointFolder::list(folder + "/checkpoint").empty();
    commands.push_back(command_for(study, run, folder, resume));
    started.push_back(&run);
  }
  const unsigned int n_processes =
      arguments.n_processes > 0 ? arguments.n_processes : study.n_processes;
  if (!arguments.quiet)
    std::cout << seen.size() << " runs, " << n_kept << " of them kept from "
              << "before, " << n_processes << " at a time" << std::endl;
  std::size_t n_ended = 0;
  const auto report = [&](const Ended &ended)
  {
    const StudyRun &run = *started[ended.command];
    if (arguments.quiet)
      return;
    std::cout << "[" << ++n_ended << "/" << commands.size() << "] " << run.key;
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      std::cout << (p == 0 ? ": " : ", ") << study.parameters[p].name << " "
                << study.parameters[p].values[run.choice[p]].label;
    if (ended.code != 0)
      std::cout << ": exit code " << ended.code << ": "
                << last_line(commands[ended.command].log);
    std::cout << std::endl;
  };
  return run_processes(commands, n_processes, report);
}

/** Pictures by VTK, in a process of its own under a display. */
std::string draw_pictures(const std::vector<Chart> &charts,
                          const std::string &folder)
{
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Chart &chart : charts)
    list.push_back(to_json(chart));
  make_folder(folder);
  const std::string file = folder + "/charts.json";
  write_text(file, list.dump(1) + "\n");
  const std::string program =
      fs::path(own_program()).parent_path().string() + "/sabot-charts";
  Command command;
  if (!fs::exists(program))
    return "no PNG charts: \"" + program + "\" is missing; build all targets";
  if (std::getenv("DISPLAY") == nullptr)
  {
    if (!is_on_path("xvfb-run"))
      return "no PNG charts: there is neither a DISPLAY nor xvfb-run (Debian "
             "packages xvfb and xauth); the report has its charts all the "
             "same";
    command.words = {"xvfb-run", "-a"};
  }
  command.words.insert(command.words.end(), {program, file, folder});
  command.log = folder + "/output.txt";
  int code = 0;
  run_processes({command}, 1, [&](const Ended &ended) { code = ended.code; });
  return code == 0 ? ""
                   : "no PNG charts: exit code " + std::to_string(code) + ": " +
                         last_line(command.log);
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
  make_folder(arguments.folder + "/runs");
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
  const StudyResults results(study, outcomes);
  const std::vector<Chart> charts = results.charts();
  write_csv(results, arguments.folder + "/study.csv");
  write_hdf5(results, arguments.folder + "/study.h5");
  write_report(results, charts, arguments.folder + "/report.html");
  const std::string problem =
      all_started ? draw_pictures(charts, arguments.folder + "/charts") : "";
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
