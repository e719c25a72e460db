// Arrays of .vtu files as bytes: base64, compressed blocks.
#include "sabot/geometry/vtu_bytes.h"

#include <vtkDataCompressor.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkObject.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

#include <cstring>

namespace sabot
{
namespace
{
/** Value of a letter of base64; negative: it is none. */
int six_bits(const char c)
{
  return c >= 'A' && c <= 'Z'   ? c - 'A'
         : c >= 'a' && c <= 'z' ? c - 'a' + 26
         : c >= '0' && c <= '9' ? c - '0' + 52
         : c == '+'             ? 62
         : c == '/'             ? 63
                                : -1;
}

/** Takes bytes from a text one after the other. */
class Bytes
{
public:
  Bytes(const MeshFile &file, const std::string_view text, const bool is_raw)
      : file(file), text(text), is_raw(is_raw)
  {
  }

  std::string take(const std::uint64_t n)
  {
    if (n > text.size() - at + ready.size())
      end();
    while (!is_raw && ready.size() < n)
      decode();
    std::string taken =
        is_raw ? std::string(text.substr(at, n)) : ready.substr(0, n);
    is_raw ? void(at += n) : void(ready.erase(0, n));
    return taken;
  }

  std::uint64_t number(const bool is_wide)
  {
    const std::string bytes = take(is_wide ? 8 : 4);
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }

  [[noreturn]] void end() const
  {
    file.refuse("an array ends before it is complete");
  }

private:
  /** More of the text, to the end of a group of four: what is encoded by itself
      ends with one. */
  void decode()
  {
    std::uint32_t bits = 0;
    int n = 0, n_padding = 0;
    while (n < 4 && at < text.size())
    {
      const char c = text[at];
      const int six = six_bits(c);
      if (six < 0 && c != '=' && c != ' ' && c != '\n' && c != '\r' &&
          c != '\t')
        break;
      ++at;
      if (six < 0 && c != '=')
        continue;
      n_padding += c == '=';
      bits = bits << 6 | (six < 0 ? 0 : six);
      ++n;
    }
    if (n < 4 || n_padding > 2)
      end();
    for (int b = 0; b < 3 - n_padding; ++b)
      ready += char(bits >> (16 - 8 * b) & 255);
  }

  const MeshFile &file;
  const std::string_view text;
  const bool is_raw;
  std::size_t at = 0;
  std::string ready; // decoded, not taken
};

vtkSmartPointer<vtkDataCompressor> make_compressor(const MeshFile &file,
                                                   const std::string &name)
{
  if (name == "vtkZLibDataCompressor")
    return vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (name == "vtkLZ4DataCompressor")
    return vtkSmartPointer<vtkLZ4DataCompressor>::New();
  if (name == "vtkLZMADataCompressor")
    return vtkSmartPointer<vtkLZMADataCompressor>::New();
  file.refuse("it is compressed by \"" + name.substr(0, 40) +
              "\", which is not known");
}

/** VTK does not print what goes wrong while this lives. */
class Silence
{
public:
  Silence() : before(vtkObject::GetGlobalWarningDisplay())
  {
    vtkObject::SetGlobalWarningDisplay(0);
  }
  ~Silence() { vtkObject::SetGlobalWarningDisplay(before); }
  Silence(const Silence &) = delete;
  Silence &operator=(const Silence &) = delete;

private:
  const int before;
};
} // namespace

std::string vtu_bytes(const MeshFile &file, const std::string_view text,
                      const bool is_raw, const VtuEncoding &encoding)
{
  Bytes bytes(file, text, is_raw);
  const bool is_wide = encoding.has_wide_header;
  const std::uint64_t first = bytes.number(is_wide);
  if (encoding.compressor.empty())
    return bytes.take(first);

  const auto compressor = make_compressor(file, encoding.compressor);
  const std::uint64_t size = bytes.number(is_wide),
                      size_of_last = bytes.number(is_wide);
  // A block has a length in the header, and packs a thousand to one at most.
  constexpr std::uint64_t ratio = 1100;
  if (first > text.size() / (is_wide ? 8 : 4))
    bytes.end();
  const std::uint64_t most = ratio * text.size();
  if (size > most || size_of_last > size || (first > 0 && size > most / first))
    file.refuse("blocks of " + std::to_string(size) +
                " bytes cannot come from a file of this length");
  std::vector<std::uint64_t> packed(first);
  for (std::uint64_t &length : packed)
    length = bytes.number(is_wide);
  const Silence silence;
  std::string all;
  for (std::size_t b = 0; b < packed.size(); ++b)
  {
    const bool is_part = b + 1 == packed.size() && size_of_last > 0;
    const std::string block = bytes.take(packed[b]);
    std::string plain(is_part ? size_of_last : size, '\0');
    const auto n = compressor->Uncompress(
        reinterpret_cast<const unsigned char *>(block.data()), block.size(),
        reinterpret_cast<unsigned char *>(&plain[0]), plain.size());
    if (n != plain.size())
      file.refuse("a compressed block is damaged");
    all += plain;
  }
  return all;
}
} // namespace sabot
