// Questions to a mesh of hexahedra.
#include "sabot/geometry/hex_mesh.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Signs of the corners of the reference cell, VTK order. */
constexpr int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                            {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
} // namespace

MeanGradients mean_gradients(const HexMesh &mesh, const GlobalIndex cell)
{
  std::array<Vec, 8> X;
  for (int a = 0; a < 8; ++a)
  {
    const auto &p = mesh.nodes[mesh.cells[cell][a]];
    X[a] = vec(p[0], p[1], p[2]);
  }
  return mean_gradients(X);
}

MeanGradients mean_gradients(const std::array<Vec, 8> &X)
{
  MeanGradients result;
  const double at = 1. / std::sqrt(3.);
  for (const auto &point : sign)
  {
    Vec derivative[8]; // in the reference cell
    Mat J = Mat::zero();
    for (int a = 0; a < 8; ++a)
    {
      double f[3];
      for (int d = 0; d < 3; ++d)
        f[d] = 0.5 * (1. + sign[a][d] * point[d] * at);
      derivative[a] =
          vec(0.5 * sign[a][0] * f[1] * f[2], 0.5 * sign[a][1] * f[0] * f[2],
              0.5 * sign[a][2] * f[0] * f[1]);
      add_outer(J, X[a], derivative[a]);
    }
    double det;
    const Mat to_space = transpose(inverse(J, det));
    result.volume += det;
    for (int a = 0; a < 8; ++a)
    {
      const Vec gradient = to_space * derivative[a];
      for (int d = 0; d < 3; ++d)
        result.B[a][d] += det * gradient[d];
    }
  }
  for (auto &B : result.B)
    for (double &component : B)
      component /= result.volume;
  return result;
}

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
