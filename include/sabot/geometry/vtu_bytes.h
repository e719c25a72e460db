#ifndef sabot_geometry_vtu_bytes_h
#define sabot_geometry_vtu_bytes_h

#include "sabot/geometry/file_mesh.h"

#include <string>
#include <string_view>

namespace sabot
{
/** How a .vtu stores the bytes of its arrays: the same for all of a file. */
struct VtuEncoding
{
  bool has_wide_header = false; // lengths of 8 bytes, else of 4
  std::string compressor;       // "vtkZLibDataCompressor"; "": none
};

/**
 * The bytes of an array that begins where @p text does, base64 or, with
 * @p is_raw, as they are: behind a header with their number, or with the number
 * and sizes of compressed blocks. Refuses what goes beyond @p text, and what
 * cannot have been that long before it was compressed.
 */
std::string vtu_bytes(const MeshFile &file, const std::string_view text,
                      const bool is_raw, const VtuEncoding &encoding);
} // namespace sabot

#endif
