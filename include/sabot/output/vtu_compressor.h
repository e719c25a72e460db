#ifndef sabot_output_vtu_compressor_h
#define sabot_output_vtu_compressor_h

#include <vtkZLibDataCompressor.h>

namespace sabot
{
/**
 * zlib for .vtu files that stores what does not shrink. Mantissas of fields in
 * motion are noise: zlib takes 25 ns per byte to save a tenth of them. Each
 * block is judged by its first 2 kB; those that would lose less than a fifth
 * are stored, in the format of zlib all the same: files name
 * vtkZLibDataCompressor, and whoever reads those reads these.
 */
class VtuCompressor : public vtkZLibDataCompressor
{
public:
  /** As VTK's classes have it: the caller owns a reference. */
  static VtuCompressor *New();

protected:
  VtuCompressor() = default;
  size_t CompressBuffer(const unsigned char *data, size_t size,
                        unsigned char *room, size_t room_size) override;
};
} // namespace sabot

#endif
