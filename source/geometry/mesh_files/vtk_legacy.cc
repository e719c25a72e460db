// Legacy files of VTK, up to version 5.1, text and binary.
#include "sabot/geometry/mesh_text.h"
#include "sabot/geometry/vtk_cells.h"

#include "sabot/base/text.h"

#include <algorithm>
#include <map>

namespace sabot
{
namespace
{
/** Bytes of a number of a type; 0: not known, negative: a real number. */
int size_of(const std::string &type)
{
  static const std::map<std::string, int> sizes = {
      {"char", 1},          {"signed_char", 1},
      {"unsigned_char", 1}, {"vtktypeint8", 1},
      {"vtktypeuint8", 1},  {"short", 2},
      {"vtktypeint16", 2},  {"unsigned_short", 2},
      {"vtktypeuint16", 2}, {"int", 4},
      {"unsigned_int", 4},  {"vtktypeint32", 4},
      {"vtktypeuint32", 4}, {"long", 8},
      {"unsigned_long", 8}, {"vtktypeint64", 8},
      {"vtktypeuint64", 8}, {"vtkidtype", 4}, // as VTK writes it
      {"float", -4},        {"double", -8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

class Legacy
{
public:
  explicit Legacy(const MeshFile &file) : text(file) {}

  FileMesh read()
  {
    read_header();
    while (!text.at_end() && read_section())
      ;
    if (grid.points.empty() || grid.types.empty())
      text.refuse("it has no points, no cells, or no types of cells");
    return make_file_mesh(grid, text.file);
  }

private:
  void read_header()
  {
    const std::string first(text.line()), head = "# vtk DataFile Version ";
    const auto version = first.compare(0, head.size(), head) == 0
                             ? real_number(first.substr(head.size()))
                             : std::optional<double>();
    if (!version)
      text.refuse("it does not begin with \"# vtk DataFile Version\" and a "
                  "number");
    if (*version > 5.1001)
      text.refuse("its version is newer than 5.1; save it as .vtu or in "
                  "version 4.2");
    is_old = *version < 5.;
    text.line();
    const std::string form = lower_case(std::string(text.line()));
    if (form != "ascii" && form != "binary")
      text.refuse("the third line is neither ASCII nor BINARY");
    is_binary = form == "binary";
  }

  /** A count behind a keyword, of things of @p values numbers. */
  std::size_t count(const std::size_t values) { return text.count(values); }

  std::string type()
  {
    const std::string name = lower_case(std::string(text.word()));
    if (size_of(name) == 0)
      text.refuse("numbers of a type that is not known");
    return name;
  }

  /** @p n numbers of a type, which begin after this line. */
  template <typename T>
  std::vector<T> array(const std::uint64_t n, const std::string &type)
  {
    text.line();
    const int size = size_of(type);
    text.expect(n, is_binary ? std::abs(size) : 1);
    std::vector<T> values;
    for (std::uint64_t i = 0; i < n; ++i)
      if (is_binary)
        values.push_back(number(size));
      else if (size < 0)
        values.push_back(text.real());
      else
        values.push_back(text.integer());
    return values;
  }

  /** A number whose first byte is the highest. */
  double number(const int size)
  {
    std::uint64_t bits = 0;
    const int n_bytes = std::abs(size);
    for (int b = 0; b < n_bytes; ++b)
      bits = bits << 8 | text.raw<unsigned char>();
    if (size == -8)
    {
      double value;
      std::memcpy(&value, &bits, sizeof(value));
      return value;
    }
    if (size == -4)
    {
      const std::uint32_t low = bits;
      float value;
      std::memcpy(&value, &low, sizeof(value));
      return value;
    }
    // Signs matter to no number that is used; ids and points have none.
    if (n_bytes == 4)
      return std::int32_t(bits);
    return n_bytes == 8 ? double(std::int64_t(bits)) : double(bits);
  }

  /** False where nothing behind it is needed any more. */
  bool read_section()
  {
    const std::string key = lower_case(std::string(text.word()));
    if (key == "dataset")
    {
      if (lower_case(std::string(text.line())) != "unstructured_grid")
        text.refuse("it holds no unstructured grid; save it as one (ParaView's "
                    "Append Datasets makes it)");
    }
    else if (key == "points")
    {
      const std::size_t n = count(3);
      grid.points = array<double>(3 * n, type());
    }
    else if (key == "cells")
      read_cells();
    else if (key == "cell_types")
      grid.types = array<std::int64_t>(count(1), "int");
    else if (key == "cell_data" || key == "point_data")
    {
      n_items = count(0);
      is_of_cells = key == "cell_data";
      text.line();
    }
    else if (key == "metadata")
      skip_metadata();
    else if (key == "field")
      return read_field();
    else
      return read_attribute(key);
    return true;
  }

  void read_cells()
  {
    const std::size_t n = count(1), size = count(1);
    if (!is_old)
    {
      text.line();
      if (lower_case(std::string(text.word())) != "offsets")
        text.refuse("OFFSETS are missing");
      grid.offsets = array<std::int64_t>(n, type());
      if (lower_case(std::string(text.word())) != "connectivity")
        text.refuse("CONNECTIVITY is missing");
      grid.connectivity = array<std::int64_t>(size, type());
      return;
    }
    const std::vector<std::int64_t> list = array<std::int64_t>(size, "int");
    std::size_t at = 0;
    grid.offsets.push_back(0);
    for (std::size_t c = 0; c < n; ++c)
    {
      const std::int64_t length = at < size ? list[at] : -1;
      if (length < 0 || std::uint64_t(length) > size - at - 1)
        text.refuse("the points of cell " + std::to_string(c) +
                    " go beyond the list of cells");
      grid.connectivity.insert(grid.connectivity.end(), list.begin() + at + 1,
                               list.begin() + at + 1 + length);
      at += 1 + length;
      grid.offsets.push_back(grid.connectivity.size());
    }
  }

  void skip_metadata()
  {
    text.line();
    while (!text.line().empty())
      ;
  }

  /** Keeps an array of cells that numbers parts, the better one of two. */
  void keep(const std::string &name, const std::vector<double> &values)
  {
    const auto rank = [](const std::string &of)
    { return std::find(vtk_id_names.begin(), vtk_id_names.end(), of); };
    if (!is_of_cells || rank(name) >= rank(grid.ids_name))
      return;
    grid.ids = values;
    grid.ids_name = name;
  }

  bool read_field()
  {
    text.word();
    const std::size_t n = count(4);
    for (std::size_t i = 0; i < n; ++i)
    {
      std::string name(text.word());
      while (lower_case(name) == "metadata")
      {
        skip_metadata();
        name = text.word();
      }
      const std::size_t width = count(0), n_tuples = count(0);
      const std::string of = lower_case(std::string(text.word()));
      if (size_of(of) == 0) // text, bits
        return false;
      text.expect(n_tuples, std::max<std::size_t>(width, 1));
      const auto values = array<double>(width * n_tuples, of);
      if (width == 1 && n_tuples == n_items)
        keep(name, values);
    }
    return true;
  }

  bool read_attribute(const std::string &key)
  {
    static const std::map<std::string, int> widths = {
        {"vectors", 3},    {"normals", 3},    {"tensors", 9},
        {"tensors6", 6},   {"global_ids", 1}, {"pedigree_ids", 1},
        {"edge_flags", 1}, {"scalars", 0}};
    const auto found = widths.find(key);
    if (found == widths.end())
    {
      if (grid.types.empty())
        text.refuse("the word \"" + key.substr(0, 30) +
                    "\" is none of the format");
      return false; // the mesh is complete, and the rest not needed
    }
    const std::string name(text.word()),
        of = lower_case(std::string(text.word()));
    if (size_of(of) == 0)
      return false;
    std::uint64_t width = found->second;
    if (width == 0)
    {
      const auto given = whole_number(text.line());
      width = given && *given > 0 && *given < 1000 ? *given : 1;
      text.word(); // LOOKUP_TABLE
      text.word();
    }
    text.expect(n_items, width);
    const auto values = array<double>(width * n_items, of);
    if (width == 1)
      keep(name, values);
    return true;
  }

  MeshText text;
  bool is_old = false, is_binary = false, is_of_cells = false;
  std::size_t n_items = 0; // of the data that follow
  VtkCells grid;
};

class VtkReader : public MeshReader
{
public:
  bool takes(const std::string &ending) const override
  {
    return ending == "vtk";
  }
  FileMesh read(const MeshFile &file) const override
  {
    return Legacy(file).read();
  }
};

const Registry<MeshReader>::Add
    added({"VTK", ".vtk, unstructured grids up to version 5.1.", nullptr,
           [] { return std::make_unique<VtkReader>(); }});
} // namespace
} // namespace sabot
