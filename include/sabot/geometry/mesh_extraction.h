#ifndef sabot_geometry_mesh_extraction_h
#define sabot_geometry_mesh_extraction_h

#include "sabot/geometry/hex_mesh.h"

#include <deal.II/grid/tria.h>

namespace sabot
{
/** Take nodes, cells, mean gradients, volumes and boundary faces out of
    deal.II: node numbers from a DoFHandler of trilinear elements, reordered
    along a Hilbert curve, integrals by FEValues. */
HexMesh extract_mesh(const dealii::Triangulation<3> &mesh);
} // namespace sabot

#endif
