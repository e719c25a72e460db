#ifndef sabot_geometry_local_part_h
#define sabot_geometry_local_part_h

#include "sabot/geometry/hex_mesh.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace sabot
{
/**
 * The part of a mesh that a rank holds: every cell with a node that it owns,
 * and all nodes of these cells. Cells at the border stand on several ranks and
 * are owned by the one that owns their lowest node: all of them compute such a
 * cell, the owner reports it. So a rank finds the forces on its nodes by
 * itself.
 *
 * Numbers of nodes and cells in the mesh are global and the same on every rank;
 * local numbers count what this rank holds.
 */
struct LocalPart
{
  std::vector<GlobalIndex> nodes; // owned ones, then ghosts, both ascending
  std::size_t n_owned = 0;
  std::vector<GlobalIndex> cells;                       // ascending
  std::vector<char> owned_cell;                         // parallel to cells
  std::unordered_map<GlobalIndex, std::uint32_t> local; // number in nodes

  /** Corners of the cells as numbers in nodes, VTK order. */
  std::vector<std::array<std::uint32_t, 8>>
  connectivity(const HexMesh &mesh) const;
};

/** @p owner: rank of every node of the mesh, the same on every rank. A rank
    without nodes gets an empty part. Not collective. */
LocalPart find_local_part(const HexMesh &mesh, const std::vector<int> &owner,
                          const int rank);
} // namespace sabot

#endif
