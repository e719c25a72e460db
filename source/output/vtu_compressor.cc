// Compression of .vtu files where it pays.
#include "sabot/output/vtu_compressor.h"

#include <vtkObjectFactory.h>

#include <algorithm>

namespace sabot
{
vtkStandardNewMacro(VtuCompressor);

size_t VtuCompressor::CompressBuffer(const unsigned char *const data,
                                     const size_t size,
                                     unsigned char *const room,
                                     const size_t room_size)
{
  constexpr size_t sample = 2048;
  constexpr int stored = 0, fast = 1;
  this->CompressionLevel = fast;
  const size_t looked_at = std::min(size, sample);
  const size_t left =
      vtkZLibDataCompressor::CompressBuffer(data, looked_at, room, room_size);
  if (looked_at == size && left > 0)
    return left;
  if (left > looked_at - looked_at / 5)
    this->CompressionLevel = stored;
  return vtkZLibDataCompressor::CompressBuffer(data, size, room, room_size);
}
} // namespace sabot
