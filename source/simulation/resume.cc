// Resuming a run: from which checkpoint, and which entries may change.

#include "sabot/simulation/resume.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/base/text.h"
#include "sabot/base/text_of_ranks.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/file_tools.h"
#include "sabot/simulation/run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

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
    "Checkpoint at the end",
    "Ranks per checkpoint file"};

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

/** "End time" of "set End time = 1 ms"; empty for other lines. */
std::string name_of_entry(const std::string &line)
{
  const std::string set = "set ";
  const std::size_t end = line.find('=');
  return line.compare(0, set.size(), set) == 0 && end != std::string::npos
             ? trim(line.substr(set.size(), end - set.size()))
             : "";
}

/** The lines of @p parameters on which the state depends, without comments and
    blanks at their ends. */
std::vector<std::string> binding_lines(const std::string &parameters)
{
  std::vector<std::string> lines;
  std::istringstream stream(parameters);
  int depth = 0;
  for (std::string line; std::getline(stream, line);)
  {
    line = trim(line.substr(0, line.find("# default:")));
    if (line.empty() || line[0] == '#')
      continue;
    depth += (line.compare(0, 11, "subsection ") == 0) - (line == "end");
    const bool is_free =
        depth == 0 && std::any_of(free_entries.begin(), free_entries.end(),
                                  [&](const std::string &entry)
                                  { return name_of_entry(line) == entry; });
    if (!is_free)
      lines.push_back(line);
  }
  return lines;
}

std::string identity_of(const std::string &parameters)
{
  constexpr std::size_t n_digits = 16;
  return sha256(join(binding_lines(parameters), "\n")).substr(0, n_digits);
}

/** A parameters.prm. */
struct ParametersFile
{
  std::string identity; // empty: it is of an older version, or not there
  std::string parameters;
};

const std::string before_identity = ", run ";

ParametersFile read_parameters(const std::string &name)
{
  ParametersFile file;
  std::error_code error;
  if (!std::filesystem::is_regular_file(name, error))
    return file;
  std::ifstream stream(name, std::ios::binary);
  std::string first;
  std::getline(stream, first);
  const std::size_t at = first.find(before_identity);
  if (at != std::string::npos)
    file.identity = trim(first.substr(at + before_identity.size()));
  file.parameters.assign(std::istreambuf_iterator<char>(stream), {});
  return file;
}

/** In what two scenes differ first, in words. */
std::string difference(const std::string &one, const std::string &other)
{
  const std::vector<std::string> a = binding_lines(one),
                                 b = binding_lines(other);
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && a[i] == b[i])
    ++i;
  const auto line = [i](const std::vector<std::string> &lines)
  { return i < lines.size() ? "\"" + lines[i] + "\"" : "nothing"; };
  return line(a) + " for " + line(b);
}

/** Whether a checkpoint is of the run of @p present; otherwise a warning is
    added. Where the parameters.prm does not tell, all belong. */
bool belongs(const CheckpointHeader &header, const std::string &file,
             const ParametersFile &present, const std::string &scene,
             ResumePoint &point)
{
  const std::string identity = identity_of(header.parameters);
  if (present.identity.empty() || identity == present.identity)
    return true;
  point.warnings.push_back("checkpoint \"" + file +
                           "\" is of another run than \"" + scene +
                           "\" and passed over: its scene has " +
                           difference(header.parameters, present.parameters));
  return false;
}

/** The work of the others: look at their share of each checkpoint that rank 0
    names, until it names none. Rank 0 says what was wrong. */
void help_to_verify(MPI_Comm communicator)
{
  for (std::string file;;)
  {
    broadcast_text(file, communicator);
    if (file.empty())
      return;
    try
    {
      CheckpointFile::verify(file, communicator);
    }
    catch (const IOError &)
    {
    }
    catch (const InputError &)
    {
    }
  }
}

/** The work of rank 0. @p verify: CheckpointFile::verify of all ranks. */
ResumePoint find_on_first_rank(
    const std::string &folder,
    const std::function<CheckpointHeader(const std::string &)> &verify)
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
  const ParametersFile present = read_parameters(point.scene);
  std::string last_problem;
  bool is_any_whole = false;
  for (const std::string &file : files)
  {
    CheckpointHeader header;
    try
    {
      header = verify(file);
    }
    catch (const IOError &e)
    {
      last_problem = e.what();
      point.warnings.push_back(last_problem + "; the one before is used");
      continue;
    }
    is_any_whole = true;
    if (!belongs(header, file, present, point.scene, point))
      continue;
    point.checkpoint = file;
    point.time = header.time;
    if (header.version != version())
      point.warnings.push_back(
          "checkpoint \"" + file + "\" was written by Sabot " + header.version +
          ", this is " + version() +
          ": the results may not be those of a run by one of them");
    if (present.parameters != header.parameters)
    {
      point.warnings.push_back("\"" + point.scene +
                               "\" is not what the checkpoint was made with; "
                               "it is put back, use --set for changes");
      write_text(point.scene,
                 parameters_file(header.version, header.parameters));
    }
    return point;
  }
  if (is_any_whole)
    throw InputError("", "\"" + folder +
                             "/checkpoint\" holds no checkpoint of this run: " +
                             point.warnings.back());
  throw IOError(last_problem + "; no checkpoint is whole");
}
} // namespace

std::string parameters_file(const std::string &version,
                            const std::string &parameters)
{
  return "# Sabot " + version + before_identity + identity_of(parameters) +
         "\n" + parameters;
}

ResumePoint find_resume_point(const std::string &folder,
                              const std::vector<std::string> &overrides,
                              MPI_Comm communicator)
{
  check_overrides(overrides);
  int rank;
  MPI_Comm_rank(communicator, &rank);
  ResumePoint point;
  std::string input_problem, file_problem;
  const auto verify = [communicator](std::string file)
  {
    broadcast_text(file, communicator);
    return CheckpointFile::verify(file, communicator);
  };
  if (rank == 0)
    try
    {
      point = find_on_first_rank(folder, verify);
    }
    catch (const InputError &e)
    {
      input_problem = e.what();
    }
    catch (const IOError &e)
    {
      file_problem = e.what();
    }
  else
    help_to_verify(communicator);
  if (std::string none; rank == 0)
    broadcast_text(none, communicator);
  for (std::string *const text :
       {&input_problem, &file_problem, &point.checkpoint, &point.scene})
    broadcast_text(*text, communicator);
  MPI_Bcast(&point.time, 1, MPI_DOUBLE, 0, communicator);
  if (!input_problem.empty())
    throw InputError("", input_problem);
  if (!file_problem.empty())
    throw IOError(file_problem);
  return point;
}
} // namespace sabot
