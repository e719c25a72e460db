// The form of checkpoints: index, checksums, reading.
#include "sabot/output/checkpoint_file.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"

#include <cerrno>
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

[[noreturn]] void damaged(const std::string &file, const std::string &what)
{
  throw IOError("checkpoint \"" + file + "\" is damaged: " + what);
}

hid_t open_file(const std::string &file)
{
  const Hdf5Quiet quiet;
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (h5 < 0)
    damaged(file, "it is not an HDF5 file or cut short");
  return h5;
}

/** Closes the file: HDF5 takes no notice of what follows its own end, and may
    do anything with a damaged file, so this is looked at first. */
const std::string trailer_start = "\nSHA-256 ";
constexpr std::size_t trailer_size = 9 + 64 + 1;

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
} // namespace

namespace checkpoint_format
{
std::string dataset_name(const int rank, const std::size_t block)
{
  return "rank " + std::to_string(rank) + "/" + std::to_string(block);
}

std::string text_of(const CheckpointHeader &header)
{
  std::ostringstream text;
  text << number << " " << header.version << " " << header.n_ranks << " "
       << header.step << " " << std::hexfloat << header.time << "\n";
  return text.str();
}

std::string text_of(const int rank, const StateLine &line)
{
  std::ostringstream text;
  text << rank << " " << line.share << " " << line.n << " " << line.size << " "
       << line.hash << " " << line.name << "\n";
  return text.str();
}

std::pair<int, StateLine> line_of(const std::string &text)
{
  std::pair<int, StateLine> found{-1, {}};
  StateLine &line = found.second;
  std::istringstream parts(text);
  parts >> found.first >> line.share >> line.n >> line.size >> line.hash;
  parts.get();
  std::getline(parts, line.name);
  return found;
}

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
} // namespace checkpoint_format

CheckpointFile::CheckpointFile(const std::string &file)
    : file(file), h5(open_file(file), H5Fclose)
{
  const Hdf5Quiet quiet;
  read_index();
}

void CheckpointFile::read_index()
{
  std::vector<char> head, text, hash, parameters;
  if (!read_bytes(h5, "header", head) || !read_bytes(h5, "index", text) ||
      !read_bytes(h5, "sha256", hash) ||
      !read_bytes(h5, "parameters", parameters))
    damaged(file, "it cannot be read");
  const std::string head_text(head.begin(), head.end()),
      index_text(text.begin(), text.end());
  its_header.parameters.assign(parameters.begin(), parameters.end());
  if (std::string(hash.begin(), hash.end()) !=
      sha256(head_text + index_text + its_header.parameters))
    damaged(file, "its index does not match its checksum");
  std::istringstream words(head_text);
  unsigned int format = 0;
  std::string time;
  words >> format >> its_header.version >> its_header.n_ranks >>
      its_header.step >> time;
  its_header.time = std::strtod(time.c_str(), nullptr);
  if (format != checkpoint_format::number)
    throw InputError("", "checkpoint \"" + file + "\" is of Sabot " +
                             its_header.version + " and has format " +
                             std::to_string(format) +
                             "; this program reads "
                             "format " +
                             std::to_string(checkpoint_format::number) +
                             ": resume it with Sabot " + its_header.version +
                             ", or run the scene anew");
  index.resize(its_header.n_ranks);
  std::istringstream lines(index_text);
  for (std::string line; std::getline(lines, line);)
  {
    auto [rank, l] = checkpoint_format::line_of(line);
    if (rank < 0 || rank >= its_header.n_ranks)
      damaged(file, "its index names a rank that it does not have");
    index[rank].push_back(std::move(l));
  }
  for (const auto &of_rank : index)
    if (of_rank.size() != index[0].size())
      damaged(file, "its ranks have different numbers of arrays");
}

std::vector<char> CheckpointFile::read(const int rank,
                                       const std::size_t number) const
{
  const Hdf5Quiet quiet;
  const StateLine &line = index[rank][number];
  std::vector<char> bytes;
  if (!read_bytes(h5, checkpoint_format::dataset_name(rank, number), bytes) ||
      bytes.size() != line.n_bytes() ||
      sha256(bytes.data(), bytes.size()) != line.hash)
    damaged(file, "\"" + line.name + "\" of rank " + std::to_string(rank) +
                      " does not match its checksum");
  return bytes;
}

CheckpointHeader CheckpointFile::verify(const std::string &file)
{
  check_trailer(file);
  const CheckpointFile checkpoint(file);
  for (int r = 0; r < checkpoint.n_ranks(); ++r)
    for (std::size_t i = 0; i < checkpoint.lines(r).size(); ++i)
      if (checkpoint_format::is_stored(r, checkpoint.lines(r)[i]))
        checkpoint.read(r, i);
  return checkpoint.header();
}
} // namespace sabot
