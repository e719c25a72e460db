#ifndef sabot_geometry_mesh_layers_h
#define sabot_geometry_mesh_layers_h

#include "sabot/geometry/hex_mesh.h"

#include <array>
#include <string>

namespace sabot
{
/**
 * Cells that are much thinner than the next one across their larger faces: a
 * sliver between a zone and the surface, say, that makes the step short for
 * nothing. The height of a cell between two opposite faces is its volume over
 * the mean of their areas.
 */
struct ThinLayer
{
  std::size_t n_cells = 0;                   // 0: there is none
  double height = 0., neighbor = 0.;         // of the worst, [m]
  std::array<double, 3> place{{0., 0., 0.}}; // its center [m]
  /** For a warning; without the name of the body. */
  std::string text() const;
};

/** Heights differ by more than 4 at one face; graded meshes grow by 3 at
    most. */
ThinLayer find_thin_layer(const HexMesh &mesh);
} // namespace sabot

#endif
