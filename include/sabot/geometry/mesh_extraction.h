#ifndef sabot_geometry_mesh_extraction_h
#define sabot_geometry_mesh_extraction_h

#include "sabot/geometry/hex_mesh.h"

// deal.II's grids take seconds to parse: their headers are for source files.
namespace dealii
{
template <int dim, int spacedim>
class Triangulation;
}

namespace sabot
{
/**
 * Takes a mesh of hexahedra out of deal.II, after which the program needs
 * nothing of it: active cells, no hanging nodes. Node numbers come from a
 * DoFHandler of trilinear elements, then nodes and cells are reordered along a
 * Hilbert curve, so that neighbors in space are neighbors in memory and the
 * numbering depends on the coordinates only. Not collective; the same on every
 * rank that has the same mesh.
 */
HexMesh extract_mesh(const dealii::Triangulation<3, 3> &mesh);
} // namespace sabot

#endif
