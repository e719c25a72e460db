#ifndef sabot_geometry_cell_shape_h
#define sabot_geometry_cell_shape_h

#include "sabot/kernels/vec.h"

#include <array>

namespace sabot
{
/** Corners of a hexahedron in VTK order. */
using CellCorners = std::array<Vec, 8>;

/** Faces of a hexahedron in VTK order, outward by the right-hand rule. */
inline constexpr int face_corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7},
                                           {0, 1, 5, 4}, {1, 2, 6, 5},
                                           {2, 3, 7, 6}, {3, 0, 4, 7}};

/** Mean of the corners. */
Vec middle(const CellCorners &x);

/** Determinant of dx/dxi in the middle of the cell, xi in [-1, 1]^3. */
double middle_jacobian(const CellCorners &x);

/** Least determinant of dx/dxi in the middle and at the 2x2x2 Gauss points:
    where it is not positive no integration can use the cell. */
double least_inner_jacobian(const CellCorners &x);

double shortest_edge(const CellCorners &x);
double longest_edge(const CellCorners &x);

/** The corner with the least scaled Jacobian: the determinant of its three
    edges over the product of their lengths, 1 for boxes, 0 where an edge has no
    length. */
struct CornerShape
{
  double scaled_jacobian = 1.;
  int number = 0;
};
CornerShape worst_corner(const CellCorners &x);
} // namespace sabot

#endif
