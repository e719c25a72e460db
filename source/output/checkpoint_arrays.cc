// Arrays of ranks on their way into the file that one of them writes.
#include "sabot/output/checkpoint_arrays.h"

#include "sabot/base/error.h"
#include "sabot/base/hash.h"
#include "sabot/base/text_of_ranks.h"

#include <algorithm>
#include <exception>
#include <sstream>

namespace sabot
{
namespace
{
using namespace checkpoint_format;

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

/** Calls @p take(line, number, data) for each finished line. @return whether
    the state was shown to its end; never throws. */
template <typename Take>
bool show(const checkpoint_arrays::Visit &visit,
          const std::vector<StateLine> &of_first, const Take &take)
{
  std::size_t number = 0;
  StateSaver saver(
      [&](const StateLine &shown, const void *const data)
      {
        take(finished_line(shown, data, of_first, number), number, data);
        ++number;
      });
  try
  {
    visit(saver);
    return number == of_first.size();
  }
  catch (const std::exception &)
  {
    return false; // others wait; all are told at the end
  }
}

/** Write the arrays of rank @p r, number @p source of the group, as they
 * arrive.
 */
bool receive_arrays(const int r, const int source, const hid_t h5,
                    std::string &index, std::vector<char> &piece,
                    MPI_Comm communicator)
{
  bool good = true;
  for (std::size_t number = 0;; ++number)
  {
    unsigned long length = 0;
    MPI_Recv(&length, 1, MPI_UNSIGNED_LONG, source, 0, communicator,
             MPI_STATUS_IGNORE);
    if (length == all_sent || length == gone_wrong)
      return good && length == all_sent;
    std::string text;
    receive(length, source, communicator, piece,
            [&](const char *const data, const std::size_t n)
            { text.append(data, n); });
    index += text;
    const StateLine line = line_of(text).second;
    if (!is_stored(r, line))
      continue;
    ByteSet set(h5, dataset_name(r, number), line.n_bytes());
    receive(line.n_bytes(), source, communicator, piece,
            [&](const char *const data, const std::size_t n)
            { good = good && set.append(data, n); });
  }
}
} // namespace

namespace checkpoint_arrays
{
bool write_bytes(const hid_t file, const std::string &name, const void *data,
                 const std::size_t n_bytes)
{
  return ByteSet(file, name, n_bytes).append(data, n_bytes);
}

bool write_first(const hid_t h5, const Visit &visit,
                 std::vector<StateLine> &lines, std::string &index)
{
  bool good = true;
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
  return good;
}

bool write_own(const hid_t h5, const Visit &visit,
               const std::vector<StateLine> &of_first, const int rank,
               std::string &index)
{
  bool good = true;
  const bool all =
      show(visit, of_first,
           [&](const StateLine &line, const std::size_t number,
               const void *const data)
           {
             index += text_of(rank, line);
             if (is_stored(rank, line))
               good = good && write_bytes(h5, dataset_name(rank, number), data,
                                          line.n_bytes());
           });
  return all && good;
}

bool receive_others(const hid_t h5, const RankGroup &group, std::string &index)
{
  bool good = true;
  std::vector<char> piece;
  for (int r = 1; r < group.n_ranks; ++r)
    good = receive_arrays(group.first() + r, r, h5, index, piece,
                          group.communicator) &&
           good;
  return good;
}

void send_own(const Visit &visit, const std::vector<StateLine> &of_first,
              const int rank, const RankGroup &group)
{
  const bool all =
      show(visit, of_first,
           [&](const StateLine &line, std::size_t, const void *const data)
           {
             const std::string text = text_of(rank, line);
             send_length(text.size(), group.communicator);
             send(text.data(), text.size(), group.communicator);
             if (is_stored(rank, line))
               send(data, line.n_bytes(), group.communicator);
           });
  send_length(all ? all_sent : gone_wrong, group.communicator);
}

void tell_lines(std::vector<StateLine> &lines, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::string text;
  for (const StateLine &line : lines)
    text += text_of(0, line);
  broadcast_text(text, communicator);
  std::istringstream stream(text);
  for (std::string line; rank != 0 && std::getline(stream, line);)
    lines.push_back(line_of(line).second);
}
} // namespace checkpoint_arrays
} // namespace sabot
