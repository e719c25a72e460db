// Resuming a run: from which checkpoint, and which entries may change.

#include "sabot/simulation/resume.h"

#include "sabot/base/error.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/file_tools.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sabot
{
namespace
{
/** Entries that may change between two parts of a run: nothing that was saved
    depends on them. */
const std::vector<std::string> free_entries = {
    "End time",
    "Step factor",
    "Largest step",
    "Energy residual limit",
    "Checkpoint interval",
    "Checkpoint interval in steps",
    "Checkpoint interval of wall time",
    "Checkpoint at the end"};

void check_overrides(const std::vector<std::string> &overrides)
{
  for (const std::string &text : overrides)
  {
    std::string name = text.substr(0, text.find('='));
    while (!name.empty() && name.back() == ' ')
      name.pop_back();
    if (std::find(free_entries.begin(), free_entries.end(), name) !=
        free_entries.end())
      continue;
    std::string allowed;
    for (const std::string &entry : free_entries)
      allowed += (allowed.empty() ? "" : ", ") + entry;
    throw InputError("", "--set \"" + text +
                             "\": a resumed run can only change " + allowed);
  }
}

void broadcast(std::string &text, MPI_Comm communicator)
{
  unsigned long length = text.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, 0, communicator);
  text.resize(length);
  MPI_Bcast(&text[0], length, MPI_CHAR, 0, communicator);
}

ResumePoint find_on_one_rank(const std::string &folder, const int n_ranks)
{
  if (!std::filesystem::is_directory(folder))
    throw InputError("", "no results folder \"" + folder + "\"");
  const std::vector<std::string> files =
      CheckpointFolder::list(folder + "/checkpoint");
  if (files.empty())
    throw InputError("", "\"" + folder +
                             "/checkpoint\" holds no checkpoint; a run leaves "
                             "one when it is interrupted, at the intervals "
                             "that its scene sets and, unless \"Checkpoint at "
                             "the end\" is false, when it is finished");
  ResumePoint point;
  point.scene = folder + "/parameters.prm";
  std::string last_problem;
  for (const std::string &file : files)
  {
    CheckpointHeader header;
    try
    {
      header = CheckpointFolder::verify(file);
    }
    catch (const IOError &e)
    {
      last_problem = e.what();
      point.warnings.push_back(last_problem + "; the one before is used");
      continue;
    }
    if (header.n_ranks != n_ranks)
      throw InputError("", "checkpoint \"" + file + "\" was written on " +
                               std::to_string(header.n_ranks) +
                               " ranks and can only be resumed on as many; "
                               "use mpirun -np " +
                               std::to_string(header.n_ranks));
    point.checkpoint = file;
    point.time = header.time;
    std::ifstream stream(point.scene, std::ios::binary);
    std::string present{std::istreambuf_iterator<char>(stream), {}};
    present.erase(0, present.find('\n') + 1); // the version
    if (present != header.parameters)
    {
      point.warnings.push_back("\"" + point.scene +
                               "\" is not what the checkpoint was made with; "
                               "it is put back, use --set for changes");
      write_text(point.scene,
                 "# Sabot " + header.version + "\n" + header.parameters);
    }
    return point;
  }
  throw IOError(last_problem + "; no checkpoint is whole");
}
} // namespace

ResumePoint find_resume_point(const std::string &folder,
                              const std::vector<std::string> &overrides,
                              MPI_Comm communicator)
{
  check_overrides(overrides);
  int rank, n_ranks;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  ResumePoint point;
  std::string input_problem, file_problem;
  if (rank == 0)
    try
    {
      point = find_on_one_rank(folder, n_ranks);
    }
    catch (const InputError &e)
    {
      input_problem = e.what();
    }
    catch (const IOError &e)
    {
      file_problem = e.what();
    }
  for (std::string *const text :
       {&input_problem, &file_problem, &point.checkpoint, &point.scene})
    broadcast(*text, communicator);
  MPI_Bcast(&point.time, 1, MPI_DOUBLE, 0, communicator);
  if (!input_problem.empty())
    throw InputError("", input_problem);
  if (!file_problem.empty())
    throw IOError(file_problem);
  return point;
}
} // namespace sabot
