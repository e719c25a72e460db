#ifndef sabot_geometry_curve_order_h
#define sabot_geometry_curve_order_h

#include "sabot/geometry/hex_mesh.h"

namespace sabot
{
/**
 * A mesh with its nodes and cells numbered along a Hilbert curve, so that
 * neighbors in space are neighbors in memory and the numbering depends on the
 * coordinates only, but for those of one place on the curve, which keep their
 * order. Of @p mesh come nodes, cells and boundary faces with their ids;
 * @p face_cell: the cell of each face, as they are numbered there. Faces follow
 * their cells, those of one cell in the order they come in. Volumes are set.
 */
HexMesh sorted_along_curve(HexMesh mesh, std::vector<GlobalIndex> face_cell);
} // namespace sabot

#endif
