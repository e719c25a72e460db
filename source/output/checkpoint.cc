// Writing of checkpoints: what all ranks have, through rank 0 into one file.
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

const std::string prefix = "step-", ending = ".h5";

/** An array of bytes in the file, written from its start to its end. */
class ByteSet
{
public:
  ByteSet(const hid_t file, const std::string &name, const hsize_t n)
      : space(n > 0 ? H5Screate_simple(1, &n, nullptr) : H5Screate(H5S_NULL),
              H5Sclose),
        links(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
        properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose),
        set(create(file, name), H5Dclose)
  {
  }
  /** Whether there was no trouble. */
  bool append(const void *const data, const hsize_t n)
  {
    if (set < 0 || n == 0)
      return set >= 0;
    const Hdf5Handle piece(H5Screate_simple(1, &n, nullptr), H5Sclose);
    const bool good =
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &n_written, nullptr, &n,
                            nullptr) >= 0 &&
        H5Dwrite(set, H5T_NATIVE_UCHAR, piece, space, H5P_DEFAULT, data) >= 0;
    n_written += n;
    return good;
  }

private:
  hid_t create(const hid_t file, const std::string &name) const
  {
    H5Pset_create_intermediate_group(links, 1);
    H5Pset_obj_track_times(properties, false);
    H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
    return H5Dcreate2(file, name.c_str(), H5T_NATIVE_UCHAR, space, links,
                      properties, H5P_DEFAULT);
  }
  const Hdf5Handle space, links, properties, set;
  hsize_t n_written = 0;
};

bool write_bytes(const hid_t file, const std::string &name, const void *data,
                 const std::size_t n_bytes)
{
  return ByteSet(file, name, n_bytes).append(data, n_bytes);
}

/** Of what ranks send [bytes]. */
constexpr std::size_t piece_size = std::size_t(1) << 22;

void send(const void *const data, const std::size_t n_bytes,
          MPI_Comm communicator)
{
  const char *const begin = static_cast<const char *>(data);
  for (std::size_t i = 0; i < n_bytes; i += piece_size)
    MPI_Send(begin + i, std::min(piece_size, n_bytes - i), MPI_CHAR, 0, 0,
             communicator);
}

/** Calls @p take(piece, length) for what @p source sends. */
template <typename Take>
void receive(const std::size_t n_bytes, const int source, MPI_Comm communicator,
             std::vector<char> &piece, const Take &take)
{
  for (std::size_t i = 0; i < n_bytes; i += piece_size)
  {
    const std::size_t n = std::min(piece_size, n_bytes - i);
    piece.resize(piece_size);
    MPI_Recv(piece.data(), n, MPI_CHAR, source, 0, communicator,
             MPI_STATUS_IGNORE);
    take(piece.data(), n);
  }
}

/** What ranks send before each array: how long its line is; after the last one
    whether all went well. */
constexpr unsigned long all_sent = 0, gone_wrong = ~0ul;

void send_length(const unsigned long length, MPI_Comm communicator)
{
  MPI_Send(&length, 1, MPI_UNSIGNED_LONG, 0, 0, communicator);
}

/** With the checksum, and marked as this rank's own where all ranks should have
    the same and rank 0 has another. */
StateLine finished_line(StateLine line, const void *const data,
                        const std::vector<StateLine> &of_first,
                        const std::size_t number)
{
  line.hash = sha256(data, line.n_bytes());
  if (number >= of_first.size() || of_first[number].name != line.name)
    throw IOError("the ranks do not save the same arrays: \"" + line.name +
                  "\"");
  if (line.share == static_cast<char>(StateShare::same) &&
      line.hash != of_first[number].hash)
    line.share = static_cast<char>(StateShare::own);
  return line;
}

/** What a rank other than 0 does of write(): each line of its part of the
   index, and the array. */
void send_arrays(const CheckpointFolder::Visit &visit,
                 const std::vector<StateLine> &of_first, const int rank,
                 MPI_Comm communicator)
{
  std::size_t number = 0;
  StateSaver saver(
      [&](const StateLine &shown, const void *const data)
      {
        const StateLine line = finished_line(shown, data, of_first, number++);
        const std::string text = text_of(rank, line);
        send_length(text.size(), communicator);
        send(text.data(), text.size(), communicator);
        if (is_stored(rank, line))
          send(data, line.n_bytes(), communicator);
      });
  unsigned long end = gone_wrong;
  try
  {
    visit(saver);
    if (number == of_first.size())
      end = all_sent;
  }
  catch (const std::exception &)
  {
    // Rank 0 waits, and tells all.
  }
  send_length(end, communicator);
}

/** Write the arrays of rank @p r as they arrive, and add its lines to
    @p index. @return whether there was no trouble; the rank is heard to the
    end even then. */
bool receive_arrays(const int r, const hid_t h5, std::string &index,
                    std::vector<char> &piece, MPI_Comm communicator)
{
  bool good = true;
  for (std::size_t number = 0;; ++number)
  {
    unsigned long length = 0;
    MPI_Recv(&length, 1, MPI_UNSIGNED_LONG, r, 0, communicator,
             MPI_STATUS_IGNORE);
    if (length == all_sent || length == gone_wrong)
      return good && length == all_sent;
    std::string text;
    receive(length, r, communicator, piece,
            [&](const char *const data, const std::size_t n)
            { text.append(data, n); });
    index += text;
    const StateLine line = line_of(text).second;
    if (!is_stored(r, line))
      continue;
    ByteSet set(h5, dataset_name(r, number), line.n_bytes());
    receive(line.n_bytes(), r, communicator, piece,
            [&](const char *const data, const std::size_t n)
            { good = good && set.append(data, n); });
  }
}

/** Of rank 0, to all: names and checksums. Collective. */
void tell_lines(std::vector<StateLine> &lines, const int rank,
                MPI_Comm communicator)
{
  std::string text;
  for (const StateLine &line : lines)
    text += text_of(0, line);
  unsigned long length = text.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, 0, communicator);
  text.resize(length);
  MPI_Bcast(&text[0], length, MPI_CHAR, 0, communicator);
  std::istringstream stream(text);
  for (std::string line; rank != 0 && std::getline(stream, line);)
    lines.push_back(line_of(line).second);
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
} // namespace

CheckpointFolder::CheckpointFolder(const std::string &folder,
                                   MPI_Comm communicator)
    : folder(folder), communicator(communicator)
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

void CheckpointFolder::clear()
{
  if (rank != 0)
    return;
  std::error_code ignored;
  for (const std::string &file : list(folder))
    fs::remove(file, ignored);
  fs::remove(folder + "/failed" + ending, ignored);
}

bool CheckpointFolder::write_arrays(const hid_t h5, const Visit &visit,
                                    std::string &index) const
{
  bool good = true;
  std::vector<StateLine> lines;
  StateSaver saver(
      [&](StateLine line, const void *const data)
      {
        line.hash = sha256(data, line.n_bytes());
        good = good && write_bytes(h5, dataset_name(0, lines.size()), data,
                                   line.n_bytes());
        index += text_of(0, line);
        lines.push_back(std::move(line));
      });
  visit(saver);
  tell_lines(lines, rank, communicator);
  // All ranks are heard to the end, even when the disk is full.
  std::vector<char> piece;
  for (int r = 1; r < n_ranks; ++r)
    good = receive_arrays(r, h5, index, piece, communicator) && good;
  return good;
}

std::size_t
CheckpointFolder::write_file(const CheckpointHeader &header, const Visit &visit,
                             const std::string &name,
                             const std::function<void()> &begin) const
{
  std::ostringstream number;
  number << prefix << std::setw(10) << std::setfill('0') << header.step;
  const std::string file =
      folder + "/" + (name.empty() ? number.str() : name) + ending;
  write_atomically(
      file,
      [&](const std::string &temporary)
      {
        const Hdf5Quiet quiet;
        Hdf5Writer h5(temporary, file);
        begin();
        std::string index;
        bool good = write_arrays(h5, visit, index);
        const std::string head = text_of(header),
                          hash = sha256(head + index + header.parameters);
        for (const auto &[what, text] :
             {std::pair<std::string, std::string>{"header", head},
              {"parameters", header.parameters},
              {"index", index},
              {"sha256", hash}})
          good = good && write_bytes(h5, what, text.data(), text.size());
        h5.close();
        if (!good)
          throw IOError("cannot write \"" + file +
                        "\": HDF5 could not lay it out, or a rank could not "
                        "save its state");
        append_trailer(temporary, file);
        flush_to_disk(temporary, file);
      });
  std::error_code ignored;
  return fs::file_size(file, ignored);
}

std::size_t CheckpointFolder::write(const CheckpointHeader &header,
                                    const Visit &visit,
                                    const std::string &name) const
{
  // Before anybody sends: all hear of it, and nobody waits.
  std::string problem = trouble();
  throw_together(problem);
  std::size_t n_bytes = 0;
  if (rank != 0)
  {
    throw_together("");
    std::vector<StateLine> of_first;
    tell_lines(of_first, rank, communicator);
    send_arrays(visit, of_first, rank, communicator);
  }
  else
  {
    bool has_begun = false;
    try
    {
      n_bytes = write_file(header, visit, name,
                           [&]()
                           {
                             has_begun = true;
                             throw_together("");
                           });
      std::error_code ignored;
      const std::vector<std::string> files = list(folder);
      for (std::size_t i = 2; i < files.size(); ++i)
        fs::remove(files[i], ignored);
    }
    catch (const IOError &e)
    {
      // Why, where the folder went away within the write.
      problem = trouble().empty() ? e.what() : trouble();
    }
    if (!has_begun)
      throw_together(problem);
  }
  throw_together(problem);
  return n_bytes;
}

std::vector<std::string> CheckpointFolder::list(const std::string &folder)
{
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
  {
    const fs::path path = entry->path();
    if (path.filename().string().compare(0, prefix.size(), prefix) == 0 &&
        path.extension() == ending)
      files.push_back(path.string());
  }
  std::sort(files.rbegin(), files.rend()); // numbers have leading zeros
  return files;
}
} // namespace sabot
