#ifndef sabot_geometry_boundary_planes_h
#define sabot_geometry_boundary_planes_h

#include "sabot/geometry/hex_mesh.h"

namespace sabot
{
/** Axis (0, 1, 2) across which all boundary faces with the id @p id lie in one
    plane; -1 where they do not, or there are none. */
int plane_axis(const HexMesh &mesh, const unsigned int id);
} // namespace sabot

#endif
