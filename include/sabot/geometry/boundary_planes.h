#ifndef sabot_geometry_boundary_planes_h
#define sabot_geometry_boundary_planes_h

#include "sabot/geometry/hex_mesh.h"

#include <optional>

namespace sabot
{
/** Axis (0, 1, 2) across which all boundary faces with the id @p id lie in one
    plane, to a millionth of their edges; nothing where they do not, or where
    there are none. The same on every rank, not collective. */
std::optional<int> plane_axis(const HexMesh &mesh, const unsigned int id);
} // namespace sabot

#endif
