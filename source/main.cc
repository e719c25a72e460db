// The program: its command line, and what each command calls.
#include "sabot/base/error_report.h"
#include "sabot/base/mpi_session.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/program.h"
#include "sabot/base/stop_signals.h"
#include "sabot/output/file_lock.h"
#include "sabot/output/file_tools.h"
#include "sabot/reference/reference.h"
#include "sabot/simulation/plan.h"
#include "sabot/simulation/results_folder.h"
#include "sabot/simulation/resume.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"
#include "sabot/study/pictures.h"
#include "sabot/study/process_pool.h"
#include "sabot/study/study.h"
#include "sabot/study/study_file.h"

#include <mpi.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>

namespace sabot
{
/** In the file that scripts/revision.cmake writes. */
std::string source_revision();
} // namespace sabot

namespace
{
using namespace sabot;

struct Arguments
{
  std::string scene, folder = "results", format = "markdown";
  std::vector<std::string> scenes; // to check
  std::vector<std::string> overrides;
  std::vector<std::string> words; // for sabot-verify
  std::string json_file;
  bool quiet = false, list = false, is_about_studies = false;
  bool overwrite = false, is_about_memory = false;
  StudyArguments study;
  PictureArguments picture;
};

/** What the command line asks for. A study starts processes that use MPI and
    must not be one itself. */
struct Action
{
  std::function<ExitCode(const Arguments &)> run;
  bool uses_mpi = true;
};

bool is_first_rank()
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

/** Build the scene of @p file and do @p work with it; what is wrong with the
    scene is told with the file's lines. */
template <typename Work>
ExitCode with_scene(const ParameterFile &file, const Work &work)
{
  try
  {
    Scene scene(file, MPI_COMM_WORLD);
    stop_early_when_asked(MPI_COMM_WORLD);
    return work(scene);
  }
  catch (const InputError &error)
  {
    throw InputError("", file.located(error));
  }
}

ExitCode run_scene(const Arguments &arguments)
{
  listen_to_stop_signals();
  const ParameterFile file(arguments.scene, arguments.overrides);
  return with_scene(
      file,
      [&](Scene &scene)
      {
        const FolderLock lock(arguments.folder, true, MPI_COMM_WORLD);
        claim_results_folder(arguments.folder, arguments.overwrite,
                             MPI_COMM_WORLD);
        return Run(scene, arguments.folder, arguments.quiet, MPI_COMM_WORLD)
            .execute();
      });
}

void print_notes(const Scene &scene)
{
  for (const std::string &note : scene.notes)
    std::cout << note << "\n";
}

ExitCode check_scene(const std::string &name,
                     const std::vector<std::string> &overrides)
{
  const ParameterFile file(name, overrides);
  return with_scene(file,
                    [&](Scene &scene)
                    {
                      const PhysicsPlan physics = plan_physics(scene);
                      scene.distribute();
                      add_warnings(physics, scene);
                      if (!is_first_rank())
                        return ExitCode::done;
                      for (const std::string &warning : scene.warnings)
                        std::cout << "warning: " << warning << "\n";
                      print_notes(scene);
                      std::cout << name << " is valid:";
                      for (const auto &body : scene.bodies)
                        std::cout << " " << body->name << " ("
                                  << body->n_items() << " " << body->item_name()
                                  << ")";
                      std::cout << std::endl;
                      return ExitCode::done;
                    });
}

/** Each with its own answer; of several scenes the largest exit code. */
ExitCode check_scenes(const Arguments &arguments)
{
  if (arguments.scenes.size() == 1)
    return check_scene(arguments.scenes[0], arguments.overrides);
  int code = 0;
  for (const std::string &name : arguments.scenes)
  {
    if (is_first_rank())
      std::cout << "checking " << name << std::endl;
    code = std::max(
        code,
        report_errors(true, [&]()
                      { return check_scene(name, arguments.overrides); }));
  }
  return static_cast<ExitCode>(code);
}

ExitCode plan_scene(const Arguments &arguments)
{
  const ParameterFile file(arguments.scene, arguments.overrides);
  return with_scene(file,
                    [&](Scene &scene)
                    {
                      if (arguments.is_about_memory)
                      {
                        const std::string tables =
                            plan_memory(scene, MPI_COMM_WORLD);
                        if (is_first_rank())
                          std::cout << tables << std::flush;
                        return ExitCode::done;
                      }
                      PhysicsPlan physics = plan_physics(scene);
                      constexpr double calibration_seconds = 1.;
                      const CostPlan cost = plan_cost(
                          scene, physics, calibration_seconds, MPI_COMM_WORLD);
                      if (!is_first_rank())
                        return ExitCode::done;
                      add_warnings(physics, scene);
                      physics.warnings = scene.warnings;
                      print_notes(scene);
                      std::cout << to_text(physics, cost) << std::flush;
                      if (!arguments.json_file.empty())
                        write_text(arguments.json_file,
                                   to_json(physics, cost).dump(2) + "\n");
                      return ExitCode::done;
                    });
}

ExitCode resume_run(const Arguments &arguments)
{
  listen_to_stop_signals();
  const FolderLock lock(arguments.folder, false, MPI_COMM_WORLD);
  const ResumePoint point =
      find_resume_point(arguments.folder, arguments.overrides, MPI_COMM_WORLD);
  const ParameterFile file(point.scene, arguments.overrides);
  return with_scene(
      file,
      [&](Scene &scene)
      {
        scene.warnings.insert(scene.warnings.begin(), point.warnings.begin(),
                              point.warnings.end());
        if (point.time >= scene.settings.end_time)
          throw InputError("End time",
                           "the checkpoint \"" + point.checkpoint +
                               "\" is of a later time; a resumed run can only "
                               "end later than that");
        return Run(scene, arguments.folder, arguments.quiet, MPI_COMM_WORLD)
            .execute(point.checkpoint);
      });
}

ExitCode describe_parameters(const Arguments &arguments)
{
  Parameters prm;
  if (arguments.is_about_studies)
    StudyFile::declare(prm, {"<name>"}, {"<name>"});
  else
    Scene::declare(prm, nullptr);
  if (!is_first_rank())
    return ExitCode::done;
  if (arguments.format == "markdown")
    print_manual(prm, std::cout);
  else
    print_parameters(prm, arguments.format, std::cout);
  return ExitCode::done;
}

/** Become sabot-verify, a program of its own beside this one: what only
    compares with exact answers is not part of what users run. */
ExitCode start_verification(std::vector<std::string> words)
{
  const std::string program =
      std::filesystem::path(own_program()).parent_path() / "sabot-verify";
  if (!std::filesystem::exists(program))
    throw InputError("", "\"" + program +
                             "\" is missing; scripts/build.sh builds it");
  words.insert(words.begin(), program);
  std::vector<char *> pointers;
  for (std::string &word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  throw IOError("cannot start \"" + program + "\"");
}

ExitCode write_reference(const Arguments &arguments)
{
  make_folder(arguments.folder);
  for (const ReferencePage &page : reference_pages())
    write_text(arguments.folder + "/" + page.file, page.text);
  return start_verification({"--page", arguments.folder + "/problems.md"});
}

void add_overrides(CLI::App &command, std::vector<std::string> &overrides,
                   const std::string &meaning)
{
  command.add_option("--set", overrides, meaning)->allow_extra_args(false);
}

const char *const override_meaning = "Replace an entry: \"Section/Name=value\"";

void add_scene(CLI::App &command, Arguments &arguments)
{
  command.add_option("scene", arguments.scene, "Scene file (.prm)")->required();
  add_overrides(command, arguments.overrides, override_meaning);
}

void add_run(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &command = *app.add_subcommand("run", "Run a scene");
  add_scene(command, arguments);
  command.add_option("-o,--output", arguments.folder, "Folder for the results")
      ->capture_default_str();
  command.add_flag("--overwrite", arguments.overwrite,
                   "Replace the results that the folder holds");
  command.add_flag("--quiet", arguments.quiet, "Write to log.txt only");
  command.callback([&]() { action = {run_scene}; });
}

void add_resume(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &command = *app.add_subcommand(
      "resume",
      "Continue a run from its newest checkpoint: an interrupted one, "
      "or a finished one to a later end time");
  command.add_option("folder", arguments.folder, "Folder with the results")
      ->required();
  add_overrides(command, arguments.overrides,
                "Replace an entry on which the state does not depend: "
                "\"End time=value\"");
  command.add_flag("--quiet", arguments.quiet, "Write to log.txt only");
  command.callback([&]() { action = {resume_run}; });
}

void add_check(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &command =
      *app.add_subcommand("check", "Check scenes without running them");
  command.add_option("scenes", arguments.scenes, "Scene files (.prm)")
      ->required();
  add_overrides(command, arguments.overrides, override_meaning);
  command.callback([&]() { action = {check_scenes}; });
}

void add_plan(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &command = *app.add_subcommand(
      "plan", "Say what a scene needs and costs before running it");
  add_scene(command, arguments);
  command.add_option("--json", arguments.json_file,
                     "Also write it to this file");
  command.add_flag("--memory", arguments.is_about_memory,
                   "Tables of bytes by array instead");
  command.callback([&]() { action = {plan_scene}; });
}

void add_study(CLI::App &app, StudyArguments &study, Action &action)
{
  CLI::App &command = *app.add_subcommand(
      "study", "Vary the parameters of a scene; tables, charts and a report");
  command.add_option("study", study.file, "Study file (.prm)")->required();
  add_overrides(command, study.overrides,
                "Replace an entry of the study: \"Section/Name=value\"");
  command.add_option("-o,--output", study.folder, "Folder")
      ->default_val("results-study");
  command.add_option("--runs", study.runs,
                     "Folder of the runs, which several studies may share "
                     "(default: runs in the study's folder)");
  command.add_option("--processes", study.n_processes,
                     "Runs at the same time; 0: as the study file says");
  command.add_flag("--retry", study.retry, "Run again what failed");
  command.add_flag("--renew", study.renew,
                   "Run again what another build of the program made");
  command.add_flag("--list", study.list,
                   "Check the study and list its runs without running them");
  command.add_flag("--quiet", study.quiet, "Say nothing");
  command.callback(
      [&]()
      {
        action = {[](const Arguments &all) { return run_study(all.study); },
                  false};
      });
}

void add_picture(CLI::App &app, PictureArguments &picture, Action &action)
{
  CLI::App &command = *app.add_subcommand(
      "picture", "Draw a section through the bodies of a run as PNG");
  command.add_option("folder", picture.folder, "Folder with the results")
      ->required();
  command.add_option("-o,--output", picture.file,
                     "Picture (default: section.png in the folder)");
  command.add_option("--field", picture.field,
                     "Field that colors the bodies (default: effective "
                     "plastic strain, or velocity where nothing can yield)");
  command.add_option("--time", picture.times,
                     "Times, separated by commas: \"20 us, 0.1 ms\", of the "
                     "nearest frames (default: the last)");
  command
      .add_option("--normal", picture.normal,
                  "Axis across the plane of the section")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command.add_option("--at", picture.position,
                     "Position of the plane along it: \"0 mm\"");
  command.add_option("--range", picture.range,
                     "Limits of the colors: \"0, 1\" (SI)");
  command.add_option("--window", picture.window,
                     "Part to show, to the right and up: \"-30 mm, 30 mm, -40 "
                     "mm, 20 mm\"");
  command.add_option("--title", picture.title, "Title (default: the scene's)");
  command.callback(
      [&]()
      {
        action = {[](const Arguments &all)
                  { return draw_picture(all.picture); },
                  false};
      });
}

void add_manuals(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &parameters =
      *app.add_subcommand("parameters", "Print the manual of all entries");
  parameters.add_option("--format", arguments.format, "")
      ->check(CLI::IsMember({"markdown", "prm", "json", "xml"}))
      ->capture_default_str();
  parameters.add_flag("--study", arguments.is_about_studies,
                      "Of study files instead of scenes");
  parameters.callback([&]() { action = {describe_parameters}; });
  CLI::App &reference = *app.add_subcommand(
      "reference", "Write the pages of the reference: entries, problems, "
                   "fields, energies, exit codes");
  reference.add_option("folder", arguments.folder, "Folder for the pages")
      ->required();
  reference.callback([&]() { action = {write_reference, false}; });
}

void add_verify(CLI::App &app, Arguments &arguments, Action &action)
{
  CLI::App &command = *app.add_subcommand(
      "verify", "Compare verification problems with exact answers");
  command.set_help_flag();
  command.prefix_command();
  command.callback(
      [&]()
      {
        arguments.words = command.remaining();
        action = {[](const Arguments &all)
                  { return start_verification(all.words); },
                  false};
      });
}

/** Whether the first word is no command, which is then said. */
bool is_unknown_command(const CLI::App &app, const int argc, char **argv)
{
  const std::string word = argc > 1 ? argv[1] : "-";
  std::vector<std::string> commands;
  for (const CLI::App *const command : app.get_subcommands({}))
    commands.push_back(command->get_name());
  if (word[0] == '-' ||
      std::find(commands.begin(), commands.end(), word) != commands.end())
    return false;
  const std::string meant = suggestion(word, commands);
  std::cerr << "error: there is no command \"" << word << "\"" << meant
            << (meant.empty() ? ";" : "") << " `sabot --help` lists them\n";
  return true;
}
} // namespace

int main(int argc, char **argv)
{
  Arguments arguments;
  Action action;
  CLI::App app("Sabot: coupled FEM-SPG simulation of impact");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  add_run(app, arguments, action);
  add_resume(app, arguments, action);
  add_check(app, arguments, action);
  add_plan(app, arguments, action);
  add_study(app, arguments.study, action);
  add_picture(app, arguments.picture, action);
  add_manuals(app, arguments, action);
  add_verify(app, arguments, action);
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &e)
  {
    if (is_unknown_command(app, argc, argv))
      return static_cast<int>(ExitCode::bad_input);
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  const auto act = [&]() { return action.run(arguments); };
  if (!action.uses_mpi)
    return report_errors(false, act);
  program_facts() = {command_text(argc, argv), source_revision()};
  const MpiSession mpi(argc, argv);
  return report_errors(true, act);
}
