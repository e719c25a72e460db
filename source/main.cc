#include "sabot/base/parameter_file.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"
#include "sabot/verification/problem.h"

#include <deal.II/base/mpi.h>

#include <CLI/CLI.hpp>

#include <iostream>

namespace
{
using namespace sabot;

struct Arguments
{
  std::string scene, folder = "results", format = "markdown";
  std::vector<std::string> overrides;
  std::vector<std::string> problems;
  std::string json_file;
  bool quiet = false, list = false;
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

ExitCode print_parameters(const Arguments &arguments)
{
  using dealii::ParameterHandler;
  ParameterHandler prm;
  Scene::declare(prm, nullptr);
  const auto style = arguments.format == "prm"    ? ParameterHandler::Text
                     : arguments.format == "json" ? ParameterHandler::JSON
                     : arguments.format == "xml"
                         ? ParameterHandler::XML
                         : ParameterHandler::Description;
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    if (arguments.format == "markdown")
      print_manual(prm, std::cout);
    else
      prm.print_parameters(std::cout,
                           style | ParameterHandler::KeepDeclarationOrder);
  }
  return ExitCode::done;
}

ExitCode run_verification(const Arguments &arguments)
{
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    throw InputError("", "`sabot verify` runs on one rank");
  if (arguments.list)
  {
    list_problems();
    return ExitCode::done;
  }
  return verify(arguments.problems, arguments.json_file)
             ? ExitCode::done
             : ExitCode::physics_failed;
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
  CLI::App *const check =
      app.add_subcommand("check", "Check a scene without running it");
  add_scene(check);
  CLI::App *const parameters =
      app.add_subcommand("parameters", "Print the manual of all entries");
  parameters->add_option("--format", arguments.format, "")
      ->check(CLI::IsMember({"markdown", "prm", "json", "xml"}))
      ->capture_default_str();
  CLI::App *const verification = app.add_subcommand(
      "verify", "Compare verification problems with exact answers");
  verification->add_option("name", arguments.problems,
                           "Problems or labels; none: all quick ones");
  verification->add_flag("--list", arguments.list, "Name the problems");
  verification->add_option("--json", arguments.json_file,
                           "Write the checks to this file");
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &e)
  {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }

  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool speaks =
      dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  ExitCode code = ExitCode::done;
  try
  {
    code = *parameters     ? print_parameters(arguments)
           : *verification ? run_verification(arguments)
                           : run_scene(arguments, bool(*check));
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
