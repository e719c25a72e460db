// Tables over time, as compound datasets of HDF5.
#include "sabot/output/history.h"

#include "sabot/base/error.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/hdf5_tools.h"

#include <stdexcept>

namespace sabot
{
namespace
{
hid_t row_type(const std::vector<std::string> &columns)
{
  const hid_t type = H5Tcreate(H5T_COMPOUND, columns.size() * sizeof(double));
  for (std::size_t c = 0; c < columns.size(); ++c)
    H5Tinsert(type, columns[c].c_str(), c * sizeof(double), H5T_NATIVE_DOUBLE);
  return type;
}
/** Columns of a table of a file; none where it has not just what this program
    writes: rows of doubles that need no conversion, and no more of them than
   the file has room for. HDF5 may do anything with other types. */
std::vector<std::string> columns_of(const hid_t type, const hid_t space,
                                    const double file_size)
{
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (H5Tget_class(type) != H5T_COMPOUND || n < 0 ||
      double(n) * double(H5Tget_size(type)) > file_size)
    return {};
  std::vector<std::string> columns;
  for (int c = 0; c < H5Tget_nmembers(type); ++c)
  {
    char *const name = H5Tget_member_name(type, c);
    columns.push_back(name == nullptr ? "" : name);
    H5free_memory(name);
  }
  const Hdf5Handle expected(row_type(columns), H5Tclose);
  return H5Tequal(type, expected) > 0 ? columns : std::vector<std::string>();
}
} // namespace

void History::append(const std::string &name, const Measures &row)
{
  Table &table = tables[name];
  if (table.columns.empty())
    for (const Measure &m : row)
      table.columns.push_back(m.name + " [" + m.unit + "]");
  if (row.size() != table.columns.size())
    throw std::logic_error("history table " + name + " changed its columns");
  for (const Measure &m : row)
    table.values.push_back(m.value);
}

void History::write(const std::string &file) const
{
  // HDF5 builds the file in memory: after a write to a full disk it would keep
  // a file that it cannot close, and crash on it when the program ends.
  const Hdf5Quiet quiet;
  std::string image;
  bool good = true;
  {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    constexpr std::size_t increment = 1 << 20; // [bytes], of the memory
    H5Pset_fapl_core(access, increment, false);
    const Hdf5Handle h5(
        H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    good = h5 >= 0;
    for (const auto &[name, table] : tables)
    {
      if (!good || table.columns.empty())
        continue;
      const hsize_t n = table.n_rows();
      const Hdf5Handle type(row_type(table.columns), H5Tclose);
      const Hdf5Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose);
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_obj_track_times(properties, false);
      const Hdf5Handle set(H5Dcreate2(h5, name.c_str(), type, space,
                                      H5P_DEFAULT, properties, H5P_DEFAULT),
                           H5Dclose);
      good = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                  table.values.data()) >= 0;
    }
    good = good && H5Fflush(h5, H5F_SCOPE_GLOBAL) >= 0;
    const ssize_t size = good ? H5Fget_file_image(h5, nullptr, 0) : -1;
    good = size > 0;
    if (good)
    {
      image.resize(size);
      good = H5Fget_file_image(h5, &image[0], size) == size;
    }
  }
  if (!good)
    throw IOError("cannot write \"" + file + "\": HDF5 could not lay it out");
  write_text(file, image);
}

void History::read(const std::string &file)
{
  const Hdf5Quiet quiet;
  const Hdf5Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                      H5Fclose);
  if (h5 < 0)
    throw IOError("cannot read history \"" + file + "\"");
  tables.clear();
  hsize_t n_tables = 0, file_size = 0;
  H5Gget_num_objs(h5, &n_tables);
  H5Fget_filesize(h5, &file_size);
  for (hsize_t t = 0; t < n_tables; ++t)
  {
    char name[1024] = "";
    H5Gget_objname_by_idx(h5, t, name, sizeof(name));
    const Hdf5Handle set(H5Dopen2(h5, name, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle type(H5Dget_type(set), H5Tclose);
    const Hdf5Handle space(H5Dget_space(set), H5Sclose);
    Table &table = tables[name];
    table.columns = columns_of(type, space, double(file_size));
    if (table.columns.empty())
      throw IOError("history \"" + file + "\": \"" + name +
                    "\" is not a table of numbers");
    table.values.resize(table.columns.size() *
                        H5Sget_simple_extent_npoints(space));
    const Hdf5Handle memory(row_type(table.columns), H5Tclose);
    if (H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                table.values.data()) < 0)
      throw IOError("history \"" + file + "\": table \"" + name +
                    "\" is damaged");
  }
}
} // namespace sabot
