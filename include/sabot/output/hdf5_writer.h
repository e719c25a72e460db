#ifndef sabot_output_hdf5_writer_h
#define sabot_output_hdf5_writer_h

#include <hdf5.h>

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * A new HDF5 file whose bytes this class writes, not HDF5: raw data go to the
 * disk at once, what describes them stays in memory until the end. HDF5 keeps a
 * file that a full disk kept it from closing, and crashes on it when the
 * program ends; here it never hears of trouble. After the first error nothing
 * more is written, and close() says why. One rank writes one file with it.
 */
class Hdf5Writer
{
public:
  /** Creates @p file, or empties it; @p name: for messages. */
  Hdf5Writer(const std::string &file, const std::string &name);
  /** Without close() before, the file is of no use. Never throws. */
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer &) = delete;

  /** For HDF5's calls. */
  operator hid_t() const { return id; }
  /** Close the file; IOError with the system's reason when any of it is not on
      the disk. */
  void close();

  // What the driver that HDF5 calls does: addresses and lengths in bytes from
  // the start of the file. None of them reports trouble to HDF5.
  /** To the disk at once. */
  void write(const haddr_t address, const void *data, const std::size_t n);
  /** In memory, until close(). */
  void keep(const haddr_t address, const void *data, const std::size_t n);
  /** What was written or kept; zeros elsewhere. */
  void read(const haddr_t address, void *data, const std::size_t n) const;
  void resize(const haddr_t new_size) { size = new_size; }

private:
  /** Let HDF5 hand over what it still has. */
  void close_hdf5();

  const std::string name;
  int descriptor = -1;
  int error = 0; // errno of the first failure
  hid_t id = -1;
  bool is_good = true; // HDF5 has had no trouble of its own
  haddr_t size = 0;    // of the file
  /** What is kept, in the order in which it was written. */
  std::vector<std::pair<haddr_t, std::vector<char>>> kept;
};
} // namespace sabot

#endif
