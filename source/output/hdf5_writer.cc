// An HDF5 file whose bytes go through a driver of our own.
#include "sabot/output/hdf5_writer.h"

#include "sabot/base/error.h"
#include "sabot/output/hdf5_tools.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>

namespace sabot
{
namespace
{
/** HDF5's view of a file: a driver of its "virtual file layer". */
struct OpenFile
{
  H5FD_t base;
  Hdf5Writer *writer;
  haddr_t allocated, end;
};

OpenFile *cast(H5FD_t *file)
{
  return reinterpret_cast<OpenFile *>(file);
}

const OpenFile *cast(const H5FD_t *file)
{
  return reinterpret_cast<const OpenFile *>(file);
}

H5FD_t *open_file(const char *, unsigned, hid_t access, haddr_t)
{
  OpenFile *const file = new OpenFile();
  file->writer = *static_cast<Hdf5Writer *const *>(H5Pget_driver_info(access));
  return &file->base;
}

herr_t close_file(H5FD_t *file)
{
  delete cast(file);
  return 0;
}

int compare(const H5FD_t *a, const H5FD_t *b)
{
  const Hdf5Writer *const x = cast(a)->writer, *const y = cast(b)->writer;
  return std::less<>()(x, y) ? -1 : x != y;
}

herr_t query(const H5FD_t *, unsigned long *flags)
{
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t get_allocated(const H5FD_t *file, H5FD_mem_t)
{
  return cast(file)->allocated;
}

herr_t set_allocated(H5FD_t *file, H5FD_mem_t, haddr_t address)
{
  cast(file)->allocated = address;
  return 0;
}

haddr_t get_end(const H5FD_t *file, H5FD_mem_t)
{
  return cast(file)->end;
}

herr_t read(H5FD_t *file, H5FD_mem_t, hid_t, haddr_t address, size_t n,
            void *data)
{
  cast(file)->writer->read(address, data, n);
  return 0;
}

herr_t write(H5FD_t *file, H5FD_mem_t type, hid_t, haddr_t address, size_t n,
             const void *data)
{
  OpenFile *const f = cast(file);
  f->end = std::max(f->end, address + n);
  if (type == H5FD_MEM_DRAW)
    f->writer->write(address, data, n);
  else
    f->writer->keep(address, data, n);
  return 0;
}

herr_t truncate(H5FD_t *file, hid_t, hbool_t)
{
  OpenFile *const f = cast(file);
  f->end = f->allocated;
  f->writer->resize(f->end);
  return 0;
}

hid_t driver()
{
  static const hid_t number = []
  {
    static H5FD_class_t c = {};
#if H5_VERSION_GE(1, 13, 0)
    c.version = H5FD_CLASS_VERSION;
    c.value = H5FD_class_value_t(600); // of those that are free for all
#endif
    c.name = "sabot";
    c.maxaddr = haddr_t(1) << 62;
    c.fc_degree = H5F_CLOSE_STRONG;
    c.fapl_size = sizeof(Hdf5Writer *);
    c.open = open_file;
    c.close = close_file;
    c.cmp = compare;
    c.query = query;
    c.get_eoa = get_allocated;
    c.set_eoa = set_allocated;
    c.get_eof = get_end;
    c.read = read;
    c.write = write;
    c.truncate = truncate;
    constexpr H5FD_mem_t lists[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(lists), std::end(lists), c.fl_map);
    return H5FDregister(&c);
  }();
  return number;
}
} // namespace

Hdf5Writer::Hdf5Writer(const std::string &file, const std::string &name)
    : name(name)
{
  constexpr int mode = 0666; // what the umask leaves of it
  descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, mode);
  if (descriptor < 0)
    error = errno;
  Hdf5Writer *const self = this;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_driver(access, driver(), &self);
  id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  is_good = id >= 0;
}

Hdf5Writer::~Hdf5Writer()
{
  close_hdf5();
  if (descriptor >= 0)
    ::close(descriptor);
}

void Hdf5Writer::close_hdf5()
{
  if (id >= 0)
    is_good = H5Fclose(id) >= 0 && is_good;
  id = -1;
}

void Hdf5Writer::close()
{
  close_hdf5();
  for (const auto &[address, bytes] : kept)
    write(address, bytes.data(), bytes.size());
  kept.clear();
  if (error == 0 && ::ftruncate(descriptor, size) != 0)
    error = errno;
  if (error == 0 && ::fsync(descriptor) != 0)
    error = errno;
  if (error != 0 || !is_good)
    throw IOError(
        "cannot write \"" + name + "\": " +
        (error != 0 ? std::strerror(error) : "HDF5 could not lay it out"));
}

void Hdf5Writer::write(const haddr_t address, const void *data,
                       const std::size_t n)
{
  const char *const bytes = static_cast<const char *>(data);
  for (std::size_t done = 0; done < n && error == 0;)
  {
    const ssize_t now =
        ::pwrite(descriptor, bytes + done, n - done, address + done);
    if (now > 0)
      done += now;
    else if (now == 0)
      error = ENOSPC;
    else if (errno != EINTR)
      error = errno;
  }
}

void Hdf5Writer::keep(const haddr_t address, const void *data,
                      const std::size_t n)
{
  const char *const bytes = static_cast<const char *>(data);
  kept.emplace_back(address, std::vector<char>(bytes, bytes + n));
}

void Hdf5Writer::read(const haddr_t address, void *data,
                      const std::size_t n) const
{
  // Only what it wrote itself, should HDF5 have forgotten it.
  char *const bytes = static_cast<char *>(data);
  const ssize_t found = ::pread(descriptor, bytes, n, address);
  const std::size_t n_found = found > 0 ? found : 0;
  std::memset(bytes + n_found, 0, n - n_found);
  for (const auto &[start, part] : kept)
  {
    const haddr_t first = std::max(address, start),
                  last = std::min<haddr_t>(address + n, start + part.size());
    if (first < last)
      std::memcpy(bytes + (first - address), &part[first - start],
                  last - first);
  }
}
} // namespace sabot
