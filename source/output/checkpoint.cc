// Checkpoints as HDF5 files with checksums.
#include "sabot/output/checkpoint.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/first_rank.h"
#include "sabot/output/hdf5_tools.h"
#include "sabot/output/hdf5_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace sabot
{
namespace
{
namespace fs = std::filesystem;

const std::string prefix = "step-", ending = ".h5";

std::string dataset_name(const int rank, const std::size_t block)
{
  return "rank " + std::to_string(rank) + "/" + std::to_string(block);
}

bool write_bytes(const hid_t file, const std::string &name, const void *data,
                 const std::size_t n_bytes)
{
  const hsize_t n = n_bytes;
  const Hdf5Handle space(
      n > 0 ? H5Screate_simple(1, &n, nullptr) : H5Screate(H5S_NULL), H5Sclose);
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  const Hdf5Handle set(H5Dcreate2(file, name.c_str(), H5T_NATIVE_UCHAR, space,
                                  links, properties, H5P_DEFAULT),
                       H5Dclose);
  return set >= 0 && (n == 0 || H5Dwrite(set, H5T_NATIVE_UCHAR, H5S_ALL,
                                         H5S_ALL, H5P_DEFAULT, data) >= 0);
}

bool read_bytes(const hid_t file, const std::string &name,
                std::vector<char> &bytes)
{
  const Hdf5Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0)
    return false;
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n < 0)
    return false;
  bytes.resize(n);
  return n == 0 || H5Dread(set, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                           bytes.data()) >= 0;
}

/** Messages of any length. */
constexpr std::size_t largest_message = std::size_t(1) << 30;

void send(const std::vector<char> &bytes, MPI_Comm communicator)
{
  for (std::size_t i = 0; i < bytes.size(); i += largest_message)
    MPI_Send(&bytes[i], std::min(largest_message, bytes.size() - i), MPI_CHAR,
             0, 0, communicator);
}

void receive(std::vector<char> &bytes, const int source, MPI_Comm communicator)
{
  for (std::size_t i = 0; i < bytes.size(); i += largest_message)
    MPI_Recv(&bytes[i], std::min(largest_message, bytes.size() - i), MPI_CHAR,
             source, 0, communicator, MPI_STATUS_IGNORE);
}

/** A line of the index: rank, length, size of an entry, hash, name. */
struct IndexLine
{
  int rank;
  std::size_t n, size;
  std::string hash, name;
};

void add_line(std::ostream &index, const IndexLine &l)
{
  index << l.rank << " " << l.n << " " << l.size << " " << l.hash << " "
        << l.name << "\n";
}

[[noreturn]] void damaged(const std::string &file, const std::string &what)
{
  throw IOError("checkpoint \"" + file + "\" is damaged: " + what);
}

/** Header and index, compared with the hash over both. */
std::vector<IndexLine> read_index(const hid_t h5, const std::string &file,
                                  CheckpointHeader &header)
{
  std::vector<char> head, index, hash, parameters;
  if (!read_bytes(h5, "header", head) || !read_bytes(h5, "index", index) ||
      !read_bytes(h5, "sha256", hash) ||
      !read_bytes(h5, "parameters", parameters))
    damaged(file, "it cannot be read");
  const std::string head_text(head.begin(), head.end()),
      index_text(index.begin(), index.end());
  header.parameters.assign(parameters.begin(), parameters.end());
  if (std::string(hash.begin(), hash.end()) !=
      sha256(head_text + index_text + header.parameters))
    damaged(file, "its index does not match its checksum");
  std::istringstream words(head_text);
  unsigned int file_format = 0;
  words >> file_format >> header.version >> header.n_ranks >> header.step >>
      std::hexfloat;
  std::string time;
  words >> time;
  header.time = std::strtod(time.c_str(), nullptr);
  if (file_format != CheckpointFolder::format)
    throw IOError("checkpoint \"" + file + "\" has format " +
                  std::to_string(file_format) + "; this program reads format " +
                  std::to_string(CheckpointFolder::format));
  std::vector<IndexLine> lines;
  std::istringstream text(index_text);
  for (std::string line; std::getline(text, line);)
  {
    IndexLine l;
    std::istringstream parts(line);
    parts >> l.rank >> l.n >> l.size >> l.hash;
    parts.get();
    std::getline(parts, l.name);
    lines.push_back(l);
  }
  return lines;
}

/** Blocks of @p rank, or of all ranks when it is negative. */
std::vector<StateBlock> read_blocks(const std::string &file, const int rank,
                                    CheckpointHeader &header, const bool keep)
{
  const Hdf5Quiet quiet;
  const Hdf5Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                      H5Fclose);
  if (h5 < 0)
    damaged(file, "it is not an HDF5 file or cut short");
  const std::vector<IndexLine> lines = read_index(h5, file, header);
  std::vector<StateBlock> blocks;
  int of_rank = -1;
  std::size_t number = 0;
  for (const IndexLine &l : lines)
  {
    number = l.rank == of_rank ? number + 1 : 0;
    of_rank = l.rank;
    if (rank >= 0 && l.rank != rank)
      continue;
    StateBlock block{l.name, l.n, l.size, {}};
    if (!read_bytes(h5, dataset_name(l.rank, number), block.bytes) ||
        block.bytes.size() != l.n * l.size ||
        sha256(block.bytes.data(), block.bytes.size()) != l.hash)
      damaged(file, "\"" + l.name + "\" of rank " + std::to_string(l.rank) +
                        " does not match its checksum");
    if (keep)
      blocks.push_back(std::move(block));
  }
  return blocks;
}

/** Closes the file: HDF5 takes no notice of what follows its own end, and may
    do anything with a damaged file, so this is looked at first. */
const std::string trailer_start = "\nSHA-256 ";
constexpr std::size_t trailer_size = 9 + 64 + 1;

/** To @p file, which will be called @p name. */
void append_trailer(const std::string &file, const std::string &name)
{
  std::error_code error;
  const std::size_t size = fs::file_size(file, error);
  if (error)
    throw IOError("cannot write \"" + name + "\": " + error.message());
  const std::string hash = sha256_of_file(file, size);
  errno = 0;
  std::ofstream stream(file, std::ios::binary | std::ios::app);
  stream << trailer_start << hash << "\n";
  stream.close();
  if (hash.empty() || !stream)
    throw IOError("cannot write \"" + name + "\": " + std::strerror(errno));
}

void check_trailer(const std::string &file)
{
  std::error_code error;
  const std::size_t size = fs::file_size(file, error);
  if (error || size < trailer_size)
    damaged(file, "it is cut short");
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(size - trailer_size);
  std::string trailer(trailer_size, ' ');
  stream.read(&trailer[0], trailer_size);
  if (trailer !=
      trailer_start + sha256_of_file(file, size - trailer_size) + "\n")
    damaged(file, "its bytes do not match its checksum");
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

/** What a rank other than 0 does of write(): its part of the index, then its
    arrays. */
void send_blocks(const std::string &lines,
                 const std::vector<StateBlock> &blocks, MPI_Comm communicator)
{
  unsigned long length = lines.size();
  MPI_Send(&length, 1, MPI_UNSIGNED_LONG, 0, 0, communicator);
  send(std::vector<char>(lines.begin(), lines.end()), communicator);
  for (const StateBlock &block : blocks)
    send(block.bytes, communicator);
}

/** Write the arrays of rank @p r as they arrive, and add its lines to
    @p index. @return whether HDF5 had no trouble; the rank is heard to the
    end even then. */
bool receive_blocks(const int r, const hid_t h5, std::string &index,
                    MPI_Comm communicator)
{
  unsigned long length = 0;
  MPI_Recv(&length, 1, MPI_UNSIGNED_LONG, r, 0, communicator,
           MPI_STATUS_IGNORE);
  std::vector<char> text(length);
  receive(text, r, communicator);
  index.append(text.begin(), text.end());
  std::istringstream stream(std::string(text.begin(), text.end()));
  std::size_t b = 0;
  bool good = true;
  for (std::string line; std::getline(stream, line); ++b)
  {
    std::istringstream parts(line);
    std::size_t of_rank, n, size;
    parts >> of_rank >> n >> size;
    std::vector<char> bytes(n * size);
    receive(bytes, r, communicator);
    good =
        good && write_bytes(h5, dataset_name(r, b), bytes.data(), bytes.size());
  }
  return good;
}

/** What rank 0 does of write(): its own arrays, those of the other ranks as
    they arrive, then header and index. IOError names the file @p name that
    @p temporary will be. */
void write_file(const std::string &temporary, const std::string &name,
                const CheckpointHeader &header, const std::string &lines,
                const std::vector<StateBlock> &blocks, MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  const Hdf5Quiet quiet;
  Hdf5Writer h5(temporary, name);
  bool good = true;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    good = good && write_bytes(h5, dataset_name(0, b), blocks[b].bytes.data(),
                               blocks[b].bytes.size());
  std::string index = lines;
  // All ranks are heard to the end, even when the disk is full.
  for (int r = 1; r < n_ranks; ++r)
    good = receive_blocks(r, h5, index, communicator) && good;
  std::ostringstream head;
  head << CheckpointFolder::format << " " << header.version << " " << n_ranks
       << " " << header.step << " " << std::hexfloat << header.time << "\n";
  const std::string hash = sha256(head.str() + index + header.parameters);
  for (const auto &[what, text] :
       {std::pair<std::string, std::string>{"header", head.str()},
        {"parameters", header.parameters},
        {"index", index},
        {"sha256", hash}})
    good = good && write_bytes(h5, what, text.data(), text.size());
  h5.close();
  if (!good)
    throw IOError("cannot write \"" + name + "\": HDF5 could not lay it out");
  append_trailer(temporary, name);
  flush_to_disk(temporary, name);
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

std::size_t CheckpointFolder::write(const CheckpointHeader &header,
                                    const std::vector<StateBlock> &blocks,
                                    const std::string &name) const
{
  std::ostringstream lines;
  for (const StateBlock &block : blocks)
    add_line(lines,
             {rank, block.n, block.size,
              sha256(block.bytes.data(), block.bytes.size()), block.name});
  // Before anybody sends: all hear of it, and nobody waits.
  std::string problem = trouble();
  throw_together(problem);
  std::size_t n_bytes = 0;
  if (rank != 0)
    send_blocks(lines.str(), blocks, communicator);
  else
    try
    {
      std::ostringstream number;
      number << prefix << std::setw(10) << std::setfill('0') << header.step;
      const std::string file =
          folder + "/" + (name.empty() ? number.str() : name) + ending;
      write_atomically(file,
                       [&](const std::string &temporary) {
                         write_file(temporary, file, header, lines.str(),
                                    blocks, communicator);
                       });
      std::error_code ignored;
      n_bytes = fs::file_size(file, ignored);
      const std::vector<std::string> files = list(folder);
      for (std::size_t i = 2; i < files.size(); ++i)
        fs::remove(files[i], ignored);
    }
    catch (const IOError &e)
    {
      // Why, where the folder went away within the write.
      problem = trouble().empty() ? e.what() : trouble();
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

CheckpointHeader CheckpointFolder::verify(const std::string &file)
{
  CheckpointHeader header;
  check_trailer(file);
  read_blocks(file, -1, header, false);
  return header;
}

std::vector<StateBlock> CheckpointFolder::read(const std::string &file,
                                               const int rank)
{
  CheckpointHeader header;
  return read_blocks(file, rank, header, true);
}
} // namespace sabot
