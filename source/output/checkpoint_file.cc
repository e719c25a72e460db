// The form of checkpoints: index, checksums, further files, reading.
#include "sabot/output/checkpoint_file.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/base/text_of_ranks.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
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

/** @return the digest. */
std::string check_trailer(const std::string &file)
{
  std::error_code error;
  const std::size_t size = fs::file_size(file, error);
  if (error || size < trailer_size)
    damaged(file, error ? error.message() : "it is cut short");
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(size - trailer_size);
  std::string trailer(trailer_size, ' ');
  stream.read(&trailer[0], trailer_size);
  const std::string hash = sha256_of_file(file, size - trailer_size);
  if (trailer != trailer_start + hash + "\n")
    damaged(file, "its bytes do not match its checksum");
  return hash;
}

std::string text_in(const hid_t h5, const std::string &name,
                    const std::string &file)
{
  std::vector<char> bytes;
  if (!read_bytes(h5, name, bytes))
    damaged(file, "it cannot be read");
  return std::string(bytes.begin(), bytes.end());
}

CheckpointHeader header_of(const std::string &text, const std::string &file)
{
  CheckpointHeader header;
  std::istringstream words(text);
  unsigned int format = 0;
  std::string time;
  words >> format >> header.version >> header.n_ranks >> header.step >> time;
  header.time = std::strtod(time.c_str(), nullptr);
  if (format != checkpoint_format::number)
    throw InputError("", "checkpoint \"" + file + "\" is of Sabot " +
                             header.version + " and has format " +
                             std::to_string(format) +
                             "; this program reads "
                             "format " +
                             std::to_string(checkpoint_format::number) +
                             ": resume it with Sabot " + header.version +
                             ", or run the scene anew");
  return header;
}

std::vector<char> array_of(const hid_t h5, const std::string &file,
                           const StateLine &line, const int rank,
                           const std::size_t number)
{
  std::vector<char> bytes;
  if (!read_bytes(h5, checkpoint_format::dataset_name(rank, number), bytes) ||
      bytes.size() != line.n_bytes() ||
      sha256(bytes.data(), bytes.size()) != line.hash)
    damaged(file, "\"" + line.name + "\" of rank " + std::to_string(rank) +
                      " does not match its checksum");
  return bytes;
}

void check_part(const std::string &file, const checkpoint_format::Part &part)
{
  const std::string name = checkpoint_format::part_name(file, part.first);
  if (check_trailer(name) != part.hash)
    damaged(name, "it is not the one that \"" + file + "\" was written with");
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

std::string append_trailer(const std::string &file, const std::string &name)
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
  return hash;
}

std::string part_name(const std::string &file, const int first)
{
  const fs::path path(file);
  return (path.parent_path() /
          (path.stem().string() + ".rank-" + std::to_string(first) +
           path.extension().string()))
      .string();
}

std::string text_of(const Part &part)
{
  return std::to_string(part.first) + " " + std::to_string(part.n) + " " +
         part.hash + "\n";
}

std::vector<Part> parts_of(const std::string &text)
{
  std::vector<Part> parts;
  std::istringstream words(text);
  for (Part part; words >> part.first >> part.n >> part.hash;)
    parts.push_back(part);
  return parts;
}
} // namespace checkpoint_format

struct CheckpointFile::OneFile
{
  OneFile(const std::string &file, const int first)
      : name(file), first(first), h5(open_file(file), H5Fclose)
  {
  }
  const std::string name;
  const int first; // rank
  const Hdf5Handle h5;
};

CheckpointFile::CheckpointFile(const std::string &file)
{
  const Hdf5Quiet quiet;
  const auto parts = checkpoint_format::parts_of(add_file(file, 0));
  for (const checkpoint_format::Part &part : parts)
    add_file(checkpoint_format::part_name(file, part.first), part.first);
  for (const auto &of_rank : index)
    if (of_rank.size() != index[0].size())
      damaged(file, "its ranks have different numbers of arrays");
}

std::string CheckpointFile::add_file(const std::string &file, const int first)
{
  files.push_back(std::make_shared<OneFile>(file, first));
  const hid_t h5 = files.back()->h5;
  const std::string head = text_in(h5, "header", file);
  const CheckpointHeader header = header_of(head, file);
  const std::string text = text_in(h5, "index", file),
                    parts = text_in(h5, "parts", file),
                    hash = text_in(h5, "sha256", file),
                    parameters = text_in(h5, "parameters", file);
  if (hash != sha256(head + text + parts + parameters))
    damaged(file, "its index does not match its checksum");
  if (first == 0)
  {
    its_header = header;
    its_header.parameters = parameters;
    index.resize(header.n_ranks);
  }
  else if (checkpoint_format::text_of(its_header) != head ||
           its_header.parameters != parameters)
    damaged(file, "it is of another step or run than the file of rank 0");
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
  {
    auto [rank, l] = checkpoint_format::line_of(line);
    if (rank < first || rank >= its_header.n_ranks)
      damaged(file, "its index names a rank that it does not have");
    index[rank].push_back(std::move(l));
  }
  return parts;
}

const CheckpointFile::OneFile &CheckpointFile::file_of(const int rank) const
{
  return **std::find_if(files.rbegin(), files.rend(),
                        [rank](const auto &file)
                        { return file->first <= rank; });
}

std::vector<char> CheckpointFile::read(const int rank,
                                       const std::size_t number) const
{
  const Hdf5Quiet quiet;
  const OneFile &file = file_of(rank);
  return array_of(file.h5, file.name, index[rank][number], rank, number);
}

void CheckpointFile::read_all(const std::size_t f) const
{
  const int last = f + 1 < files.size() ? files[f + 1]->first : n_ranks();
  for (int r = files[f]->first; r < last; ++r)
    for (std::size_t i = 0; i < index[r].size(); ++i)
      if (checkpoint_format::is_stored(r, index[r][i]))
        read(r, i);
}

CheckpointHeader CheckpointFile::verify(const std::string &file,
                                        MPI_Comm communicator)
{
  int rank, n_ranks;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  // The files as such, before HDF5 sees them; then what is in them.
  std::string problem, text;
  std::exception_ptr other; // of rank 0
  const auto is_mine = [&](const std::size_t f)
  { return int(f % n_ranks) == rank; };
  const auto seek = [&](const std::function<void()> &look)
  {
    try
    {
      look();
    }
    catch (const IOError &e)
    {
      problem = e.what();
    }
    catch (const InputError &e)
    {
      problem = e.what();
      other = std::current_exception();
    }
    problem = text_of_first(problem, communicator);
    if (other)
      std::rethrow_exception(other);
    if (!problem.empty())
      throw IOError(problem);
  };
  seek(
      [&]()
      {
        if (rank != 0)
          return;
        check_trailer(file);
        const Hdf5Quiet quiet;
        const OneFile first(file, 0);
        header_of(text_in(first.h5, "header", file), file);
        text = text_in(first.h5, "parts", file);
      });
  broadcast_text(text, communicator);
  const auto parts = checkpoint_format::parts_of(text);
  seek(
      [&]()
      {
        for (std::size_t f = 1; f <= parts.size(); ++f)
          if (is_mine(f))
            check_part(file, parts[f - 1]);
      });
  CheckpointHeader header;
  seek(
      [&]()
      {
        const CheckpointFile checkpoint(file);
        header = checkpoint.header();
        for (std::size_t f = 0; f < checkpoint.files.size(); ++f)
          if (is_mine(f))
            checkpoint.read_all(f);
      });
  return header;
}
} // namespace sabot
