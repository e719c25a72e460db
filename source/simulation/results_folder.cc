// Whether a run may write into a folder, and what of an earlier one goes.
#include "sabot/simulation/results_folder.h"

#include "sabot/base/error.h"
#include "sabot/output/checkpoint.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <regex>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

/** Status in the result.json of a folder; empty where there is none. */
std::string status_of(const std::string &folder)
{
  std::ifstream file(folder + "/result.json");
  const nlohmann::json result = nlohmann::json::parse(file, nullptr, false);
  if (!result.is_object() || !result.contains("status") ||
      !result["status"].is_string())
    return "";
  return result["status"].get<std::string>();
}

/** Why nothing may be written there; empty: nothing speaks against it. */
std::string objection(const std::string &folder)
{
  const std::string status = status_of(folder);
  if (status == "completed")
    return "\"" + folder +
           "\" holds the results of a finished run; name another folder with "
           "-o, or replace them with --overwrite";
  if (status == "failed")
    return "";
  if (status == "interrupted" ||
      !CheckpointFolder::list(folder + "/checkpoint").empty())
    return "\"" + folder +
           "\" holds a run that \"sabot resume\" can continue; name another "
           "folder with -o, or replace it with --overwrite";
  return "";
}

/** Files of @p folder whose whole names match. */
void remove_files(const std::string &folder, const std::regex &names)
{
  std::error_code error;
  for (const auto &entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) &&
        std::regex_match(entry.path().filename().string(), names))
    {
      fs::remove(entry.path(), error);
      if (error)
        throw IOError("cannot remove \"" + entry.path().string() +
                      "\": " + error.message());
    }
}

void remove_stale(const std::string &folder)
{
  remove_files(folder, std::regex("(result\\.json|history\\.h5|sabot\\.pvd)"
                                  "(\\.part)?"));
  remove_files(folder + "/fields",
               std::regex(".*_\\d{6,}(_\\d+)?\\.p?vtu(\\.part)?"));
  remove_files(folder + "/checkpoint",
               std::regex("(step-\\d+|failed)\\.h5(\\.part)?"));
}
} // namespace

void claim_results_folder(const std::string &folder, const bool overwrite,
                          MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::string problem;
  enum Kind : int
  {
    none,
    input,
    file
  };
  int kind = none;
  if (rank == 0)
  {
    problem = overwrite ? "" : objection(folder);
    kind = problem.empty() ? none : input;
    try
    {
      if (kind == none)
        remove_stale(folder);
    }
    catch (const IOError &e)
    {
      problem = e.what();
      kind = file;
    }
  }
  MPI_Bcast(&kind, 1, MPI_INT, 0, communicator);
  if (problem.empty())
    problem = "rank 0 cannot use \"" + folder + "\"";
  if (kind == input)
    throw InputError("", problem);
  if (kind == file)
    throw IOError(problem);
}
} // namespace sabot
