#ifndef sabot_geometry_hex_mesh_h
#define sabot_geometry_hex_mesh_h

#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <vector>

namespace sabot
{
/**
 * A hexahedral mesh as arrays, taken once from deal.II's triangulation and
 * DoFHandler, the same on every rank, in the reference configuration. Nodes and
 * cells are numbered along a space-filling curve. Cells list their nodes in VTK
 * order (0-3 around the bottom counter-clockwise seen from above, 4-7 above
 * them).
 */
struct HexMesh
{
  std::vector<std::array<double, 3>> nodes; // X [m]
  std::vector<std::array<GlobalIndex, 8>> cells;
  std::vector<double> volume; // of each cell [m^3], > 0
  /** Boundary quadrilaterals, outward normal by the right-hand rule, with the
      boundary id of the geometry (see the function that made the mesh). */
  std::vector<std::array<GlobalIndex, 4>> boundary_faces;
  std::vector<unsigned int> boundary_id;
};

/** Volume V [m^3] of a trilinear cell and the mean gradients of its shape
    functions, B_a = integral(dN_a/dX)/V [1/m]; sum_a B_a = 0 and sum_a X_a (x)
    B_a = 1. By 2x2x2 Gauss points, which are exact. */
struct MeanGradients
{
  double volume = 0.;
  std::array<std::array<double, 3>, 8> B{};
};
/** Of the cell with the corners @p X [m], VTK order. */
MeanGradients mean_gradients(const std::array<Vec, 8> &X);
/** Of the cell with the number @p cell, from the positions of its nodes. */
MeanGradients mean_gradients(const HexMesh &mesh, const GlobalIndex cell);

/** Nodes of the boundary faces with these ids, ascending, each once. */
std::vector<GlobalIndex> nodes_of_faces(const HexMesh &mesh,
                                        const std::vector<unsigned int> &ids);
} // namespace sabot

#endif
