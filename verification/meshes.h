#ifndef verification_meshes_h
#define verification_meshes_h

#include "sabot/geometry/hex_mesh.h"

#include <array>
#include <functional>
#include <vector>

namespace sabot
{
using MeshPoint = std::array<double, 3>; // [m]

/** A block of hexahedra before its nodes are moved. */
struct Block
{
  std::array<unsigned int, 3> n_cells; // along the axes
  MeshPoint low, high;                 // opposite corners [m]
};

/** The block with every node put where @p map says; boundary id 0. */
HexMesh mapped_block(const Block &block,
                     const std::function<MeshPoint(const MeshPoint &)> &map);

/** The same of a cube of @p n cells per edge between @p low and @p high along
    all axes; nodes are visited from the lowest along x, then y, then z. */
HexMesh mapped_cube(const unsigned int n, const double low, const double high,
                    const std::function<MeshPoint(const MeshPoint &)> &map);

/** The block without the cells whose center is in the part @p is_empty. */
HexMesh
hollow_block(const Block &block,
             const std::function<bool(const MeshPoint &center)> &is_empty);

/** Cells that share no nodes, given by their corners in lexicographic order
    (x fastest). */
HexMesh loose_cells(const std::vector<std::array<MeshPoint, 8>> &corners);
} // namespace sabot

#endif
