// Conditions of faces that ask two things of one node.
#include "sabot/base/error.h"
#include "sabot/bodies/fem/fem_boundary.h"

#include <algorithm>
#include <cstdio>

namespace sabot
{
void refuse_contradictions(const std::string &body_name, const HexMesh &mesh,
                           const FemOptions &options,
                           const std::map<unsigned int, int> &symmetry_axes)
{
  // Bits 0 to 2: held along an axis; what drives the node holds it, too.
  std::vector<unsigned char> held(mesh.nodes.size(), 0);
  std::vector<char> is_driven(mesh.nodes.size(), 0);
  const auto lists =
      [](const std::vector<unsigned int> &ids, const unsigned int id)
  { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const unsigned int id = mesh.boundary_id[f];
    const auto plane = symmetry_axes.find(id);
    for (const GlobalIndex a : mesh.boundary_faces[f])
    {
      if (lists(options.clamped_boundary_ids, id))
        held[a] |= 7;
      if (plane != symmetry_axes.end())
        held[a] |= 1 << plane->second;
      is_driven[a] |= lists(options.driven_boundary_ids, id);
    }
  }
  std::size_t n = 0, first = 0;
  for (std::size_t a = 0; a < held.size(); ++a)
  {
    bool contradicts = false;
    for (int d = 0; d < 3; ++d)
      contradicts = contradicts || (is_driven[a] && held[a] >> d & 1 &&
                                    options.driven_components[d] &&
                                    options.driven_velocity[d] != 0.);
    if (contradicts && n++ == 0)
      first = a;
  }
  if (n == 0)
    return;
  char text[300];
  std::snprintf(text, sizeof(text),
                "%zu node%s, the first at (%.6g, %.6g, %.6g) mm, would be "
                "driven and held in place (clamped, or across a plane of "
                "symmetry) at once; take the faces, or one of two faces that "
                "share an edge, out of one of the lists",
                n, n == 1 ? "" : "s", 1e3 * mesh.nodes[first][0],
                1e3 * mesh.nodes[first][1], 1e3 * mesh.nodes[first][2]);
  throw InputError("Bodies/" + body_name + "/Driven faces", text);
}
} // namespace sabot
