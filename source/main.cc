#include "sabot/base/parameter_file.h"
#include "sabot/output/file_tools.h"
#include "sabot/simulation/plan.h"
#include "sabot/simulation/resume.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"
#include "sabot/study/pictures.h"
#include "sabot/study/process_pool.h"
#include "sabot/study/study.h"
#include "sabot/study/study_file.h"

#include <deal.II/base/mpi.h>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iostream>

namespace
{
using namespace sabot;

struct Arguments
{
  std::string scene, folder = "results", format = "markdown";
  std::vector<std::string> overrides;
  std::string json_file;
  bool quiet = false, is_about_studies = false;
  StudyArguments study;
  PictureArguments picture;
};

/** "file:line: message" of bad input. */
std::string located(const InputError &error, const ParameterFile *file)
{
  const std::string message = error.what();
  if (file == nullptr || error.parameter.empty())
    return message;
  const std::string origin = file->origin(error.parameter);
  if (message.compare(0, origin.size(), origin) == 0)
    return message;
  return origin + ": " + error.parameter + ": " + message;
}

ExitCode run_scene(const Arguments &arguments, const bool check_only)
{
  const ParameterFile file(arguments.scene, arguments.overrides);
  try
  {
    Scene scene(file, MPI_COMM_WORLD);
    if (!check_only)
      return Run(scene, arguments.folder, arguments.quiet, MPI_COMM_WORLD)
          .execute();
    scene.distribute();
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
      for (const std::string &warning : scene.warnings)
        std::cout << "warning: " << warning << "\n";
      for (const std::string &note : scene.notes)
        std::cout << note << "\n";
      std::cout << arguments.scene << " is valid:";
      for (const auto &body : scene.bodies)
        std::cout << " " << body->name << " (" << body->n_items() << " "
                  << body->item_name() << ")";
      std::cout << std::endl;
    }
  }
  catch (const InputError &error)
  {
    throw InputError("", located(error, &file));
  }
  return ExitCode::done;
}

ExitCode plan_scene(const Arguments &arguments)
{
  const ParameterFile file(arguments.scene, arguments.overrides);
  try
  {
    Scene scene(file, MPI_COMM_WORLD);
    const PhysicsPlan physics = plan_physics(scene);
    constexpr double calibration_seconds = 1.;
    const CostPlan cost =
        plan_cost(scene, physics, calibration_seconds, MPI_COMM_WORLD);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
      for (const std::string &warning : scene.warnings)
        std::cout << "warning: " << warning << "\n";
      std::cout << to_text(physics, cost) << std::flush;
      if (!arguments.json_file.empty())
        write_text(arguments.json_file, to_json(physics, cost).dump(2) + "\n");
    }
  }
  catch (const InputError &error)
  {
    throw InputError("", located(error, &file));
  }
  return ExitCode::done;
}

ExitCode resume_run(const Arguments &arguments)
{
  const ResumePoint point =
      find_resume_point(arguments.folder, arguments.overrides, MPI_COMM_WORLD);
  const ParameterFile file(point.scene, arguments.overrides);
  try
  {
    Scene scene(file, MPI_COMM_WORLD);
    scene.warnings.insert(scene.warnings.begin(), point.warnings.begin(),
                          point.warnings.end());
    return Run(scene, arguments.folder, arguments.quiet, MPI_COMM_WORLD)
        .execute(point.checkpoint);
  }
  catch (const InputError &error)
  {
    throw InputError("", located(error, &file));
  }
}

ExitCode describe_parameters(const Arguments &arguments)
{
  Parameters prm;
  if (arguments.is_about_studies)
    StudyFile::declare(prm, {"<name>"}, {"<name>"});
  else
    Scene::declare(prm, nullptr);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    if (arguments.format == "markdown")
      print_manual(prm, std::cout);
    else
      sabot::print_parameters(prm, arguments.format, std::cout);
  }
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
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw IOError("cannot start \"" + program + "\"");
}

/** Run a command; what it throws becomes a message and an exit code. */
template <typename Action>
int report_errors(const bool speaks, const Action &action)
{
  ExitCode code = ExitCode::done;
  try
  {
    code = action();
  }
  catch (const InputError &error)
  {
    if (speaks)
      std::cerr << "error: " << error.what() << std::endl;
    code = ExitCode::bad_input;
  }
  catch (const IOError &error)
  {
    if (speaks)
      std::cerr << "error: " << error.what() << std::endl;
    code = ExitCode::io_failed;
  }
  return static_cast<int>(code);
}
} // namespace

int main(int argc, char **argv)
{
  Arguments arguments;
  CLI::App app("Sabot: coupled FEM-SPG simulation of impact");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  const auto add_scene = [&](CLI::App *command)
  {
    command->add_option("scene", arguments.scene, "Scene file (.prm)")
        ->required();
    command
        ->add_option("--set", arguments.overrides,
                     "Replace an entry: \"Section/Name=value\"")
        ->allow_extra_args(false);
  };
  CLI::App *const run = app.add_subcommand("run", "Run a scene");
  add_scene(run);
  run->add_option("-o,--output", arguments.folder, "Folder for the results")
      ->capture_default_str();
  run->add_flag("--quiet", arguments.quiet, "Write to log.txt only");
  CLI::App *const resume = app.add_subcommand(
      "resume", "Continue an interrupted run from its newest checkpoint");
  resume->add_option("folder", arguments.folder, "Folder with the results")
      ->required();
  resume
      ->add_option("--set", arguments.overrides,
                   "Replace an entry on which the state does not depend: "
                   "\"End time=value\"")
      ->allow_extra_args(false);
  resume->add_flag("--quiet", arguments.quiet, "Write to log.txt only");
  CLI::App *const check =
      app.add_subcommand("check", "Check a scene without running it");
  add_scene(check);
  CLI::App *const plan = app.add_subcommand(
      "plan", "Say what a scene needs and costs before running it");
  add_scene(plan);
  plan->add_option("--json", arguments.json_file, "Also write it to this file");
  CLI::App *const study = app.add_subcommand(
      "study", "Vary the parameters of a scene; tables, charts and a report");
  study->add_option("study", arguments.study.file, "Study file (.prm)")
      ->required();
  study
      ->add_option("--set", arguments.study.overrides,
                   "Replace an entry of the study: \"Section/Name=value\"")
      ->allow_extra_args(false);
  study->add_option("-o,--output", arguments.study.folder, "Folder")
      ->default_val("results-study");
  study->add_option("--runs", arguments.study.runs,
                    "Folder of the runs, which several studies may share "
                    "(default: runs in the study's folder)");
  study->add_option("--processes", arguments.study.n_processes,
                    "Runs at the same time; 0: as the study file says");
  study->add_flag("--retry", arguments.study.retry, "Run again what failed");
  study->add_flag("--renew", arguments.study.renew,
                  "Run again what another build of the program made");
  study->add_flag("--list", arguments.study.list,
                  "Check the study and list its runs without running them");
  study->add_flag("--quiet", arguments.study.quiet, "Say nothing");
  CLI::App *const picture = app.add_subcommand(
      "picture", "Draw a section through the bodies of a run as PNG");
  PictureArguments &drawn = arguments.picture;
  picture->add_option("folder", drawn.folder, "Folder with the results")
      ->required();
  picture->add_option("-o,--output", drawn.file,
                      "Picture (default: section.png in the folder)");
  picture->add_option("--field", drawn.field,
                      "Field that colours the bodies (default: effective "
                      "plastic strain, or velocity where nothing can yield)");
  picture->add_option("--time", drawn.times,
                      "Times, separated by commas: \"20 us, 0.1 ms\" (default: "
                      "the last)");
  picture
      ->add_option("--normal", drawn.normal,
                   "Axis across the plane of the section")
      ->check(CLI::IsMember({"x", "y", "z"}));
  picture->add_option("--at", drawn.position,
                      "Position of the plane along it: \"0 mm\"");
  picture->add_option("--range", drawn.range,
                      "Limits of the colours: \"0, 1\" (SI)");
  picture->add_option("--window", drawn.window,
                      "Part to show, to the right and up: \"-30 mm, 30 mm, -40 "
                      "mm, 20 mm\"");
  picture->add_option("--title", drawn.title, "Title (default: the scene's)");
  CLI::App *const parameters =
      app.add_subcommand("parameters", "Print the manual of all entries");
  parameters->add_option("--format", arguments.format, "")
      ->check(CLI::IsMember({"markdown", "prm", "json", "xml"}))
      ->capture_default_str();
  parameters->add_flag("--study", arguments.is_about_studies,
                       "Of study files instead of scenes");
  CLI::App *const verification = app.add_subcommand(
      "verify", "Compare verification problems with exact answers");
  verification->set_help_flag();
  verification->prefix_command();
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &e)
  {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }

  // A study starts processes that use MPI and must not be one itself.
  if (*study)
    return report_errors(true, [&]() { return run_study(arguments.study); });
  if (*picture)
    return report_errors(true,
                         [&]() { return draw_picture(arguments.picture); });
  if (*verification)
    return report_errors(
        true, [&]() { return start_verification(verification->remaining()); });

  // What exceeds a limit on files is an error of the write, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool speaks =
      dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  return report_errors(speaks,
                       [&]()
                       {
                         return *parameters ? describe_parameters(arguments)
                                : *resume   ? resume_run(arguments)
                                : *plan     ? plan_scene(arguments)
                                        : run_scene(arguments, bool(*check));
                       });
}
