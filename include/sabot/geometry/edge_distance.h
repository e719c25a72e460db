#ifndef sabot_geometry_edge_distance_h
#define sabot_geometry_edge_distance_h

#include "sabot/geometry/hex_mesh.h"

#include <vector>

namespace sabot
{
/**
 * Per node of @p mesh how far the boundary goes on as a plane: the shortest way
 * along sides and diagonals of its faces to a node around which they do not lie
 * in one plane [m]. 0 on edges, on curved parts and inside.
 */
std::vector<double> edge_distances(const HexMesh &mesh);
} // namespace sabot

#endif
