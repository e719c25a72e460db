// Which boundary faces lie in planes across an axis.
#include "sabot/geometry/boundary_planes.h"

#include "sabot/kernels/vec.h"

#include <cmath>

namespace sabot
{
std::optional<int> plane_axis(const HexMesh &mesh, const unsigned int id)
{
  // A face of the plane has all its area across the axis and its corners at
  // the height of the first.
  constexpr double tolerance = 1e-6;
  std::optional<int> axis;
  double height = 0.;
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    if (mesh.boundary_id[f] != id)
      continue;
    Vec x[4];
    for (int a = 0; a < 4; ++a)
    {
      const auto &p = mesh.nodes[mesh.boundary_faces[f][a]];
      x[a] = vec(p[0], p[1], p[2]);
    }
    const Vec area = 0.5 * cross(x[2] - x[0], x[3] - x[1]);
    const double size = std::sqrt(norm(area));
    if (!axis)
    {
      for (int d = 0; d < 3; ++d)
        if (std::abs(area[d]) > (1. - tolerance) * norm(area))
          axis = d;
      if (!axis)
        return std::nullopt;
      height = x[0][*axis];
    }
    for (int a = 0; a < 4; ++a)
      if (!(std::abs(x[a][*axis] - height) < tolerance * size))
        return std::nullopt;
  }
  return axis;
}
} // namespace sabot
