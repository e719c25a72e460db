// Writing of checkpoints: what all ranks have, group by group into files.
#include "sabot/output/checkpoint.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/first_rank.h"
#include "sabot/output/hdf5_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;
using namespace checkpoint_format;

const std::string prefix = "step-", failed = "failed", ending = ".h5";

/** Of "step-12.rank-16.h5": step-12. */
std::string series_of(const fs::path &file)
{
  const std::string name = file.filename().string();
  return name.substr(0, name.find('.'));
}

bool starts_with(const std::string &text, const std::string &start)
{
  return text.compare(0, start.size(), start) == 0;
}

/** Files of checkpoints, first and further ones, in no order. */
std::vector<fs::path> all_files(const std::string &folder)
{
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
  {
    const fs::path path = entry->path();
    if (path.extension() == ending &&
        (starts_with(series_of(path), prefix) || series_of(path) == failed))
      files.push_back(path);
  }
  return files;
}

void flush_to_disk(const std::string &file, const std::string &name)
{
  const int descriptor = ::open(file.c_str(), O_RDONLY);
  const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
  if (descriptor >= 0)
    ::close(descriptor);
  if (!good)
    throw IOError("cannot write \"" + name + "\": " + std::strerror(errno));
}

std::size_t size_of(const std::string &file)
{
  std::error_code error;
  const std::size_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

/** A file's arrays on their way to the disk. */
struct Draft
{
  Hdf5Writer h5;
  std::string temporary, file; // names
  bool good = true;
  std::string index, parts; // texts

  Draft(const std::string &temporary, const std::string &file)
      : h5(temporary, file), temporary(temporary), file(file)
  {
  }
  /** @return its digest. IOError. */
  std::string finish(const CheckpointHeader &header)
  {
    const std::string head = text_of(header),
                      hash = sha256(head + index + parts + header.parameters);
    for (const auto &[what, text] :
         {std::pair<std::string, std::string>{"header", head},
          {"parameters", header.parameters},
          {"index", index},
          {"parts", parts},
          {"sha256", hash}})
      good = good &&
             checkpoint_arrays::write_bytes(h5, what, text.data(), text.size());
    h5.close();
    if (!good)
      throw IOError("cannot write \"" + file +
                    "\": HDF5 could not lay it out, or a rank could not save "
                    "its state");
    const std::string digest = append_trailer(temporary, file);
    flush_to_disk(temporary, file);
    return digest;
  }
};
} // namespace

struct CheckpointFolder::FileEnd
{
  unsigned long n_bytes = 0; // 0: wrote no file
  int first = 0, n = 0;      // ranks in it
  char hash[65] = {};
  char problem[500] = {}; // empty: none
};

CheckpointFolder::CheckpointFolder(const std::string &folder,
                                   MPI_Comm communicator,
                                   const int ranks_per_file)
    : folder(folder), communicator(communicator),
      group(communicator, ranks_per_file)
{
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  on_first_rank(communicator, "write a checkpoint",
                [&]() { kept = std::make_unique<KeptFolder>(folder); });
}

void CheckpointFolder::throw_together(const std::string &problem) const
{
  int bad = !problem.empty();
  MPI_Bcast(&bad, 1, MPI_INT, 0, communicator);
  if (bad)
    throw IOError(problem.empty() ? "rank 0 could not write a checkpoint"
                                  : problem);
}

std::vector<CheckpointFolder::FileEnd>
CheckpointFolder::gather(const FileEnd &own) const
{
  std::vector<FileEnd> ends(rank == 0 ? n_ranks : 0);
  MPI_Gather(&own, sizeof(own), MPI_BYTE, ends.data(), sizeof(own), MPI_BYTE, 0,
             communicator);
  return ends;
}

void CheckpointFolder::clear()
{
  if (rank != 0)
    return;
  std::error_code ignored;
  for (const fs::path &file : all_files(folder))
    fs::remove(file, ignored);
}

void CheckpointFolder::remove_old() const
{
  std::error_code ignored;
  std::vector<std::string> files = list(folder), stay{failed};
  // First files first: what is left of a checkpoint is then none.
  for (std::size_t i = 0; i < files.size(); ++i)
    if (i < 2)
      stay.push_back(series_of(files[i]));
    else
      fs::remove(files[i], ignored);
  for (const fs::path &file : all_files(folder))
    if (std::find(stay.begin(), stay.end(), series_of(file)) == stay.end())
      fs::remove(file, ignored);
}

std::size_t
CheckpointFolder::write_first_file(const CheckpointHeader &header,
                                   const Visit &visit, const std::string &file,
                                   const std::function<void()> &begin) const
{
  std::size_t n_bytes = 0;
  write_atomically(
      file,
      [&](const std::string &temporary)
      {
        const Hdf5Quiet quiet;
        Draft draft(temporary, file);
        begin();
        std::vector<StateLine> lines;
        draft.good =
            checkpoint_arrays::write_first(draft.h5, visit, lines, draft.index);
        checkpoint_arrays::tell_lines(lines, communicator);
        // All ranks are heard to the end, even when the disk is full.
        draft.good =
            checkpoint_arrays::receive_others(draft.h5, group, draft.index) &&
            draft.good;
        std::string problem;
        for (const FileEnd &end : gather(FileEnd()))
        {
          if (problem.empty())
            problem = end.problem;
          n_bytes += end.n_bytes;
          if (end.n_bytes > 0)
            draft.parts += text_of(Part{end.first, end.n, end.hash});
        }
        if (!problem.empty())
          throw IOError(problem);
        draft.finish(header);
      });
  return n_bytes + size_of(file);
}

CheckpointFolder::FileEnd
CheckpointFolder::write_part(const CheckpointHeader &header, const Visit &visit,
                             const std::vector<StateLine> &of_first,
                             const std::string &file) const
{
  FileEnd end;
  bool has_begun = false;
  const auto tell = [&](int is_there)
  {
    has_begun = true;
    MPI_Bcast(&is_there, 1, MPI_INT, 0, group.communicator);
  };
  try
  {
    std::string hash;
    write_atomically(file,
                     [&](const std::string &temporary)
                     {
                       const Hdf5Quiet quiet;
                       Draft draft(temporary, file);
                       tell(1);
                       draft.good = checkpoint_arrays::write_own(
                           draft.h5, visit, of_first, rank, draft.index);
                       draft.good = checkpoint_arrays::receive_others(
                                        draft.h5, group, draft.index) &&
                                    draft.good;
                       hash = draft.finish(header);
                     });
    end.n_bytes = size_of(file);
    end.first = rank;
    end.n = group.n_ranks;
    std::snprintf(end.hash, sizeof(end.hash), "%s", hash.c_str());
  }
  catch (const IOError &e)
  {
    std::snprintf(end.problem, sizeof(end.problem), "%s", e.what());
    if (!has_begun)
      tell(0);
  }
  return end;
}

void CheckpointFolder::write_other(const CheckpointHeader &header,
                                   const Visit &visit,
                                   const std::string &file) const
{
  throw_together("");
  std::vector<StateLine> of_first;
  checkpoint_arrays::tell_lines(of_first, communicator);
  const std::string own = part_name(file, group.first());
  FileEnd end;
  if (group.writes())
    end = write_part(header, visit, of_first, own);
  else
  {
    int is_there = 1;
    if (group.number > 0)
      MPI_Bcast(&is_there, 1, MPI_INT, 0, group.communicator);
    if (is_there)
      checkpoint_arrays::send_own(visit, of_first, rank, group);
  }
  gather(end);
  try
  {
    throw_together("");
  }
  catch (const IOError &)
  {
    std::error_code ignored;
    if (end.n_bytes > 0)
      fs::remove(own, ignored);
    throw;
  }
}

std::size_t CheckpointFolder::write(const CheckpointHeader &header,
                                    const Visit &visit,
                                    const std::string &name) const
{
  std::ostringstream number;
  number << prefix << std::setw(10) << std::setfill('0') << header.step;
  const std::string file =
      folder + "/" + (name.empty() ? number.str() : name) + ending;
  // Before anybody sends: all hear of it, and nobody waits.
  std::string problem = trouble();
  throw_together(problem);
  if (rank != 0)
  {
    write_other(header, visit, file);
    return 0;
  }
  std::size_t n_bytes = 0;
  bool has_begun = false;
  try
  {
    n_bytes = write_first_file(header, visit, file,
                               [&]()
                               {
                                 has_begun = true;
                                 throw_together("");
                               });
    remove_old();
  }
  catch (const IOError &e)
  {
    // Why, where the folder went away within the write.
    problem = trouble().empty() ? e.what() : trouble();
  }
  if (!has_begun)
    throw_together(problem);
  throw_together(problem);
  return n_bytes;
}

std::vector<std::string> CheckpointFolder::list(const std::string &folder)
{
  std::vector<std::string> files;
  for (const fs::path &path : all_files(folder))
    if (path.stem() == series_of(path) && series_of(path) != failed)
      files.push_back(path.string());
  std::sort(files.rbegin(), files.rend()); // numbers have leading zeros
  return files;
}
} // namespace sabot
