// Questions to a mesh of hexahedra.
#include "sabot/geometry/hex_mesh.h"

#include <algorithm>

namespace sabot
{
std::vector<GlobalIndex> nodes_of_faces(const HexMesh &mesh,
                                        const std::vector<unsigned int> &ids)
{
  std::vector<GlobalIndex> nodes;
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
    if (std::find(ids.begin(), ids.end(), mesh.boundary_id[f]) != ids.end())
      nodes.insert(nodes.end(), mesh.boundary_faces[f].begin(),
                   mesh.boundary_faces[f].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}
} // namespace sabot
