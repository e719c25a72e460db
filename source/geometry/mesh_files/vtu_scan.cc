// Whether the counts in a .vtu can be true.
#include "sabot/geometry/vtu_scan.h"

#include "sabot/base/text.h"
#include "sabot/geometry/mesh_text.h"

#include <algorithm>
#include <cstring>

namespace sabot
{
namespace
{
/** Attributes of a tag by name; @p tag: between < and >. */
std::string attribute(const std::string_view tag, const std::string &name)
{
  std::size_t at = 0;
  while ((at = tag.find(name, at)) != std::string_view::npos)
  {
    const std::size_t quote =
        tag.find_first_not_of(" =\t\r\n", at + name.size());
    const bool begins = at > 0 && std::strchr(" \t\r\n", tag[at - 1]);
    at += name.size();
    if (!begins || quote == std::string_view::npos ||
        (tag[quote] != '"' && tag[quote] != '\''))
      continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end != std::string_view::npos)
      return std::string(tag.substr(quote + 1, end - quote - 1));
  }
  return "";
}

class XmlScan
{
public:
  explicit XmlScan(const MeshFile &file) : file(file), text(file.text()) {}

  void scan()
  {
    const std::size_t root = text.find("<VTKFile");
    if (root == std::string::npos)
      file.refuse("it has no element <VTKFile>");
    const std::string_view head = tag_at(root);
    if (attribute(head, "type") != "UnstructuredGrid")
      file.refuse("it holds no UnstructuredGrid; save it as one");
    if (attribute(head, "byte_order") == "BigEndian")
      file.refuse("its bytes have the order of another kind of machine; save "
                  "it as text");
    is_wide = attribute(head, "header_type") == "UInt64";
    is_compressed = !attribute(head, "compressor").empty();
    // zlib packs a thousand to one at most.
    most = is_compressed ? 1100. * text.size() : text.size();
    find_appended();
    std::size_t at = root;
    while (at < appended && (at = text.find('<', at + 1)) < appended)
      check_tag(at);
  }

private:
  std::string_view tag_at(const std::size_t at) const
  {
    return std::string_view(text).substr(
        at, std::min(text.find('>', at), text.size()) - at);
  }

  void find_appended()
  {
    appended = text.find("<AppendedData");
    if (appended == std::string::npos)
      return;
    is_raw = attribute(tag_at(appended), "encoding") == "raw";
    data = text.find('_', std::min(text.find('>', appended), text.size()));
    if (data == std::string::npos)
      file.refuse("its appended data do not begin with _");
    ++data;
  }

  void bound(const double n, const std::size_t at) const
  {
    if (!(n >= 0. && n <= most))
      file.refuse("a count of " + formatted("%.15g", n) +
                      " cannot be true of a file of this length",
                  1 + std::count(text.begin(), text.begin() + at, '\n'));
  }

  double number(const std::string_view tag, const std::string &name,
                const std::size_t at) const
  {
    const std::string found = attribute(tag, name);
    if (found.empty())
      return 0.;
    const auto value = whole_number(found);
    bound(value ? double(*value) : -1., at);
    return double(*value);
  }

  void check_tag(const std::size_t at) const
  {
    const std::string_view tag = tag_at(at);
    for (const char *const name : {"NumberOfPoints", "NumberOfCells"})
      number(tag, name, at);
    if (tag.compare(0, 10, "<DataArray") != 0 &&
        tag.compare(0, 6, "<Array") != 0)
      return;
    const double n = number(tag, "NumberOfTuples", at),
                 m = number(tag, "NumberOfComponents", at);
    bound(n * m, at);
    const std::string format = attribute(tag, "format");
    if (format == "binary")
      check_header(std::min(at + tag.size() + 1, text.size()), false, at);
    if (format == "appended")
    {
      if (appended == std::string::npos)
        file.refuse("an array is appended, but there are no appended data");
      const double offset = number(tag, "offset", at);
      if (offset >= double(text.size() - data))
        file.refuse("the offset of an array lies beyond the end");
      check_header(data + std::size_t(offset), is_raw, at);
    }
  }

  /** The lengths before the data of an array, which begin at @p from. */
  void check_header(const std::size_t from, const bool as_bytes,
                    const std::size_t at) const
  {
    const std::size_t size = is_wide ? 8 : 4;
    std::string bytes =
        as_bytes ? text.substr(from, 3 * size) : decoded(from, 3 * size);
    bytes.resize(3 * size, '\0');
    double value[3];
    for (int i = 0; i < 3; ++i)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, bytes.data() + i * size, size);
      value[i] = double(bits);
    }
    bound(value[0], at);
    if (!is_compressed)
      return;
    // Blocks, their size, and that of a last one that is not full.
    bound(value[0] * 8., at);
    bound(value[0] * value[1], at);
    bound(value[2], at);
  }

  /** @p n bytes of base64 text. */
  std::string decoded(std::size_t from, const std::size_t n) const
  {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrst"
                                "uvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int n_bits = 0;
    while (from < text.size() && bytes.size() < n)
    {
      const char c = text[from++];
      if (c == ' ' || c == '\n' || c == '\t' || c == '\r')
        continue;
      const std::size_t six = letters.find(c);
      if (six == std::string::npos)
        break;
      bits = bits << 6 | six;
      n_bits += 6;
      if (n_bits >= 8)
        bytes += char(bits >> (n_bits -= 8) & 255);
    }
    return bytes;
  }

  const MeshFile &file;
  const std::string text;
  bool is_wide = false, is_compressed = false, is_raw = false;
  double most = 0.;
  std::size_t appended = std::string::npos, data = 0;
};
} // namespace

void scan_vtu(const MeshFile &file)
{
  XmlScan(file).scan();
}
} // namespace sabot
