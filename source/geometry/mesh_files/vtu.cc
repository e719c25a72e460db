// Meshes of ParaView (.vtu): text, encoded or appended, compressed or not.
#include "sabot/geometry/mesh_text.h"
#include "sabot/geometry/vtk_cells.h"
#include "sabot/geometry/vtu_bytes.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace sabot
{
namespace
{
bool is_blank(const char c)
{
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/** A tag of XML: "DataArray", "/Points"; and its attributes as text. */
struct Tag
{
  std::string name;
  std::string_view attributes;
  std::size_t end = 0; // behind its >

  /** The value of an attribute, "" where it is not there. */
  std::string operator[](const std::string &wanted) const
  {
    std::size_t at = 0;
    while (at < attributes.size())
    {
      const std::size_t equals = attributes.find('=', at);
      if (equals == std::string_view::npos)
        return "";
      std::size_t first = at, last = equals;
      while (first < last && is_blank(attributes[first]))
        ++first;
      while (last > first && is_blank(attributes[last - 1]))
        --last;
      const std::size_t quote = attributes.find_first_of("\"'", equals);
      const std::size_t close =
          quote == std::string_view::npos
              ? quote
              : attributes.find(attributes[quote], quote + 1);
      if (close == std::string_view::npos)
        return "";
      if (attributes.substr(first, last - first) == wanted)
        return std::string(attributes.substr(quote + 1, close - quote - 1));
      at = close + 1;
    }
    return "";
  }
};

class Vtu
{
public:
  explicit Vtu(const MeshFile &file) : file(file), text(file.text()) {}

  FileMesh read()
  {
    std::size_t at = 0;
    Tag tag;
    bool has_root = false;
    grid.offsets.push_back(0);
    while (next_tag(at, tag) && tag.name != "AppendedData")
    {
      has_root = has_root || tag.name == "VTKFile";
      if (tag.name == "VTKFile")
        read_head(tag);
      else if (tag.name == "Piece")
        begin_piece(tag);
      else if (tag.name == "/Piece")
        end_piece();
      else if (tag.name == "DataArray")
        read_array(tag);
      else if (tag.name == "Points" || tag.name == "Cells" ||
               tag.name == "CellData" || tag.name == "PointData" ||
               tag.name == "FieldData")
        section = tag.name;
    }
    if (!has_root)
      file.refuse("it has no element <VTKFile>");
    return make_file_mesh(grid, file);
  }

private:
  /** The next tag from @p at on, which then stands behind it. */
  bool next_tag(std::size_t &at, Tag &tag) const
  {
    while ((at = text.find('<', at)) != std::string::npos)
    {
      if (text.compare(at, 4, "<!--") == 0)
      {
        at = std::min(text.find("-->", at), text.size());
        continue;
      }
      const std::size_t end = text.find('>', at);
      if (end == std::string::npos)
        break;
      std::size_t last = at + 1;
      while (last < end && !is_blank(text[last]) &&
             (text[last] != '/' || last == at + 1))
        ++last;
      tag.name = text.substr(at + 1, last - at - 1);
      tag.attributes = std::string_view(text).substr(last, end - last);
      tag.end = at = end + 1;
      return true;
    }
    return false;
  }

  std::size_t line_of(const Tag &tag) const
  {
    return 1 + std::count(text.begin(), text.begin() + tag.end, '\n');
  }

  void read_head(const Tag &tag)
  {
    if (tag["type"] != "UnstructuredGrid")
      file.refuse("it holds no UnstructuredGrid; save it as one");
    if (tag["byte_order"] == "BigEndian")
      file.refuse("its bytes have the order of another kind of machine; save "
                  "it as text");
    encoding.has_wide_header = tag["header_type"] == "UInt64";
    encoding.compressor = tag["compressor"];
    const std::size_t tail = text.find("<AppendedData");
    if (tail == std::string::npos)
      return;
    std::size_t at = tail;
    Tag appended;
    if (!next_tag(at, appended))
      return;
    is_raw = appended["encoding"] == "raw";
    data = text.find('_', at);
    data = data == std::string::npos ? text.size() : data + 1;
  }

  /** The count that an attribute states; things take a byte at least, or a
      thousandth of one where they are compressed. */
  std::size_t count(const Tag &tag, const std::string &name) const
  {
    const auto n = whole_number(tag[name]);
    const std::uint64_t most =
        text.size() * (encoding.compressor.empty() ? 1 : 1100);
    if (!n || *n < 0 || std::uint64_t(*n) > most)
      file.refuse(name + "=\"" + tag[name].substr(0, 30) +
                      "\" cannot be true of a file of this length",
                  line_of(tag));
    return *n;
  }

  void begin_piece(const Tag &tag)
  {
    end_piece();
    is_in_piece = true;
    n_points = count(tag, "NumberOfPoints");
    n_cells = count(tag, "NumberOfCells");
  }

  /** Of a number that may be anything: -1 where it is not from 0 to @p most. */
  static std::int64_t whole(const double value, const double most)
  {
    return value >= 0. && value <= most ? std::int64_t(value) : -1;
  }

  /** Puts what a piece has had behind the pieces before it. */
  void end_piece()
  {
    if (!is_in_piece)
      return;
    is_in_piece = false;
    if (points.size() != 3 * n_points || offsets.size() != n_cells ||
        types.size() != n_cells || (!ids.empty() && ids.size() != n_cells))
      file.refuse("it has not as many points, offsets, types or ids as it says "
                  "of its piece");
    const std::int64_t first = grid.points.size() / 3,
                       length = grid.connectivity.size();
    grid.points.insert(grid.points.end(), points.begin(), points.end());
    grid.ids.insert(grid.ids.end(), ids.begin(), ids.end());
    for (const double type : types)
      grid.types.push_back(whole(type, 255.));
    for (const double point : connectivity)
      grid.connectivity.push_back(
          whole(point, double(n_points) - 1.) < 0 ? -1 : first + point);
    for (const double offset : offsets)
      grid.offsets.push_back(
          whole(offset, connectivity.size()) < 0 ? -1 : length + offset);
    for (auto *const values : {&points, &connectivity, &offsets, &types, &ids})
      values->clear();
  }

  void read_array(const Tag &tag)
  {
    const std::string name = tag["Name"];
    if (!is_in_piece)
      return;
    if (section == "Points")
      points = values(tag);
    else if (section == "Cells" && name == "connectivity")
      connectivity = values(tag);
    else if (section == "Cells" && name == "offsets")
      offsets = values(tag);
    else if (section == "Cells" && name == "types")
      types = values(tag);
    else if (section == "CellData")
    {
      const auto rank = [](const std::string &of)
      { return std::find(vtk_id_names.begin(), vtk_id_names.end(), of); };
      const std::string width = tag["NumberOfComponents"];
      // The first pieces say which array it is.
      if ((width.empty() || width == "1") && rank(name) != vtk_id_names.end() &&
          (grid.ids.empty() ? rank(name) <= rank(grid.ids_name)
                            : name == grid.ids_name))
      {
        ids = values(tag);
        grid.ids_name = name;
      }
    }
  }

  std::vector<double> values(const Tag &tag) const
  {
    const std::string format = tag["format"];
    const std::string_view inside = std::string_view(text).substr(
        tag.end, text.find('<', tag.end) - tag.end);
    if (format == "ascii")
      return numbers(tag, inside);
    if (format == "binary")
      return numbers_of(tag, vtu_bytes(file, inside, false, encoding));
    if (format != "appended")
      file.refuse("an array has the format \"" + format.substr(0, 30) +
                      "\", none of ascii, binary and appended",
                  line_of(tag));
    const std::size_t offset = count(tag, "offset");
    if (data == 0 || offset >= text.size() - data)
      file.refuse("the offset of an array lies beyond the appended data",
                  line_of(tag));
    return numbers_of(
        tag, vtu_bytes(file, std::string_view(text).substr(data + offset),
                       is_raw, encoding));
  }

  std::vector<double> numbers(const Tag &tag, std::string_view words) const
  {
    std::vector<double> found;
    while (true)
    {
      while (!words.empty() && is_blank(words.front()))
        words.remove_prefix(1);
      if (words.empty())
        return found;
      std::size_t n = 0;
      while (n < words.size() && !is_blank(words[n]))
        ++n;
      const auto value = real_number(words.substr(0, n));
      if (!value)
        file.refuse(
            "\"" + std::string(words.substr(0, std::min<std::size_t>(n, 30))) +
                "\" stands in an array of numbers",
            line_of(tag));
      found.push_back(*value);
      words.remove_prefix(n);
    }
  }

  template <typename T>
  static std::vector<double> converted(const std::string &bytes)
  {
    std::vector<double> found(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      T value;
      std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
      found[i] = value;
    }
    return found;
  }

  std::vector<double> numbers_of(const Tag &tag, const std::string &bytes) const
  {
    const std::string type = tag["type"];
    if (type == "Float64")
      return converted<double>(bytes);
    if (type == "Float32")
      return converted<float>(bytes);
    if (type == "Int64")
      return converted<std::int64_t>(bytes);
    if (type == "UInt64")
      return converted<std::uint64_t>(bytes);
    if (type == "Int32")
      return converted<std::int32_t>(bytes);
    if (type == "UInt32")
      return converted<std::uint32_t>(bytes);
    if (type == "Int16")
      return converted<std::int16_t>(bytes);
    if (type == "UInt16")
      return converted<std::uint16_t>(bytes);
    if (type == "Int8")
      return converted<std::int8_t>(bytes);
    if (type == "UInt8")
      return converted<std::uint8_t>(bytes);
    file.refuse("an array has numbers of the type \"" + type.substr(0, 30) +
                    "\", which is not known",
                line_of(tag));
  }

  const MeshFile &file;
  const std::string text;
  VtuEncoding encoding;
  bool is_raw = false, is_in_piece = false;
  std::size_t data = 0; // where appended ones begin
  std::string section;
  std::size_t n_points = 0, n_cells = 0;
  std::vector<double> points, connectivity, offsets, types, ids; // of a piece
  VtkCells grid;
};

class VtuReader : public MeshReader
{
public:
  bool takes(const std::string &ending) const override
  {
    return ending == "vtu";
  }
  FileMesh read(const MeshFile &file) const override
  {
    return Vtu(file).read();
  }
};

const Registry<MeshReader>::Add
    added({"VTK XML", ".vtu, as ParaView saves it.", nullptr,
           [] { return std::make_unique<VtuReader>(); }});
} // namespace
} // namespace sabot
