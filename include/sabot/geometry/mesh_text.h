#ifndef sabot_geometry_mesh_text_h
#define sabot_geometry_mesh_text_h

#include "sabot/geometry/file_mesh.h"

#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace sabot
{
/** A whole number that @p word is, signs allowed; nothing where it is none or
    does not fit. */
std::optional<std::int64_t> whole_number(std::string_view word);
/** A finite number that @p word is, also with Fortran's D for the exponent. */
std::optional<double> real_number(std::string_view word);

/**
 * The text of a mesh file with a place in it. What is asked for and is not
 * there is refused, with the line. Numbers stand as words between blanks, or as
 * bytes of this machine where the caller says so.
 */
class MeshText
{
public:
  explicit MeshText(const MeshFile &file) : file(file), all(file.text()) {}

  /** Whether only blanks follow. */
  bool at_end();
  /** The next word between blanks; refuses the end of the file. */
  std::string_view word();
  /** The rest of this line, trimmed; the place is then the next one's start. */
  std::string_view line();
  std::int64_t integer();
  double real();
  /** A count of things of which each takes @p bytes at least. */
  std::size_t count(const std::size_t bytes);
  /** Refuses @p n such things where the rest of the file is too short. */
  void expect(const std::uint64_t n, const std::size_t bytes);
  /** The next bytes of the file as a T. */
  template <typename T>
  T raw()
  {
    expect(1, sizeof(T));
    T value;
    std::memcpy(&value, all.data() + at, sizeof(T));
    at += sizeof(T);
    return value;
  }
  /** Goes behind the next @p mark that begins a line; refuses where there is
      none. */
  void skip_behind(const std::string &mark);
  /** Refuses what line() or word() has just given where it is not UTF-8. */
  void check_encoding(const std::string_view found) const;
  [[noreturn]] void refuse(const std::string &why) const;

  const MeshFile &file;

private:
  /** Of the word that was read last. */
  std::size_t line_number() const;

  const std::string all;
  std::size_t at = 0;
};
} // namespace sabot

#endif
