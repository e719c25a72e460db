#ifndef sabot_geometry_vtu_scan_h
#define sabot_geometry_vtu_scan_h

#include "sabot/geometry/file_mesh.h"

namespace sabot
{
/**
 * Compares the counts of a .vtu with the length of the file, as VTK's reader
 * allocates by them: of points and cells, of the values of each array, and the
 * lengths that stand before its data, encoded or raw, compressed or not. Throws
 * InputError.
 */
void scan_vtu(const MeshFile &file);
} // namespace sabot

#endif
