// sabot-verify: the program that `sabot verify` starts.
#include "sabot/base/error.h"
#include "sabot/base/mpi_session.h"
#include "sabot/output/file_tools.h"
#include "verification/problem.h"

#include <CLI/CLI.hpp>

#include <iostream>

int main(int argc, char **argv)
{
  using namespace sabot;
  std::vector<std::string> problems;
  std::string json_file, page_file;
  bool list = false;
  CLI::App app("Compare verification problems with exact answers",
               "sabot verify");
  app.add_option("name", problems, "Problems or labels; none: all quick ones");
  app.add_flag("--list", list, "Name the problems");
  app.add_option("--json", json_file, "Write the checks to this file");
  app.add_option("--page", page_file,
                 "Write the page of the reference on problems to this file");
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &e)
  {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }

  const MpiSession mpi(argc, argv);
  try
  {
    if (mpi.n_ranks() > 1)
      throw InputError("", "`sabot verify` runs on one rank");
    if (!page_file.empty())
      write_text(page_file, problems_page());
    else if (list)
      list_problems();
    else if (!verify(problems, json_file))
      return static_cast<int>(ExitCode::physics_failed);
  }
  catch (const InputError &error)
  {
    std::cerr << "error: " << error.what() << std::endl;
    return static_cast<int>(ExitCode::bad_input);
  }
  catch (const IOError &error)
  {
    std::cerr << "error: " << error.what() << std::endl;
    return static_cast<int>(ExitCode::io_failed);
  }
  return static_cast<int>(ExitCode::done);
}
