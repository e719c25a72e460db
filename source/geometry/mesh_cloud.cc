// Particles on the nodes of hexahedra.
#include "sabot/geometry/boundary_planes.h"
#include "sabot/geometry/particle_cloud.h"
#include "sabot/kernels/eigen.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// Corners in VTK order.
constexpr double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                 {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                 {1, 1, 1},    {-1, 1, 1}};

/** Integrals of the eight trilinear functions over a cell. */
std::array<double, 8> node_volumes(const std::array<Vec, 8> &x)
{
  std::array<double, 8> volume{};
  const double g = 1. / std::sqrt(3.);
  for (const auto &s : corner)
  {
    Mat jacobian = Mat::zero();
    double value[8];
    for (int a = 0; a < 8; ++a)
    {
      const double *const c = corner[a];
      const double f0 = 1. + g * s[0] * c[0], f1 = 1. + g * s[1] * c[1],
                   f2 = 1. + g * s[2] * c[2];
      value[a] = 0.125 * f0 * f1 * f2;
      add_outer(jacobian, x[a],
                0.125 * vec(c[0] * f1 * f2, f0 * c[1] * f2, f0 * f1 * c[2]));
    }
    const double det = determinant(jacobian);
    for (int a = 0; a < 8; ++a)
      volume[a] += det * value[a];
  }
  return volume;
}

/** a a^T + b b^T + c c^T of the mean edges. */
Eigen::Matrix3d edge_moment(const std::array<Vec, 8> &x)
{
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (int d = 0; d < 3; ++d)
  {
    Vec edge = {};
    for (int a = 0; a < 8; ++a)
      edge += 0.25 * corner[a][d] * x[a];
    const Eigen::Vector3d e(edge[0], edge[1], edge[2]);
    moment += e * e.transpose();
  }
  return moment;
}

/** Volumes of the particles, and their shapes and mean spacing. */
void add_volumes(const HexMesh &mesh, ParticleCloud &cloud)
{
  const std::size_t n = mesh.nodes.size();
  cloud.volume.assign(n, 0.);
  std::vector<Eigen::Matrix3d> moment(n, Eigen::Matrix3d::Zero());
  std::vector<int> n_cells(n, 0);
  for (const auto &cell : mesh.cells)
  {
    std::array<Vec, 8> x;
    for (int a = 0; a < 8; ++a)
    {
      const auto &p = mesh.nodes[cell[a]];
      x[a] = vec(p[0], p[1], p[2]);
    }
    const std::array<double, 8> volume = node_volumes(x);
    const Eigen::Matrix3d edges = edge_moment(x);
    for (int a = 0; a < 8; ++a)
    {
      cloud.volume[cell[a]] += volume[a];
      moment[cell[a]] += edges;
      ++n_cells[cell[a]];
    }
  }
  double mean = 0.;
  for (std::size_t i = 0; i < n; ++i)
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment[i] /
                                                          n_cells[i]);
    const Mat shape = from_eigen(solver.operatorSqrt());
    cloud.shape.push_back(shape);
    mean += std::cbrt(determinant(shape)) / n;
  }
  cloud.spacing = {{mean, mean, mean}};
}

/** The particles' parts in the faces of the boundary, and which faces those
    are. */
void add_faces(const HexMesh &mesh, ParticleCloud &cloud)
{
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const auto &face = mesh.boundary_faces[f];
    Vec x[4];
    for (int a = 0; a < 4; ++a)
    {
      const auto &p = mesh.nodes[face[a]];
      x[a] = vec(p[0], p[1], p[2]);
    }
    // A quarter of the area vector each.
    const Vec area = 0.125 * cross(x[2] - x[0], x[3] - x[1]);
    for (const GlobalIndex a : face)
      cloud.face_shares.push_back({std::size_t(a), mesh.boundary_id[f], area});
    cloud.skin.push_back({{std::size_t(face[0]), std::size_t(face[1]),
                           std::size_t(face[2]), std::size_t(face[3])}});
    cloud.skin_id.push_back(mesh.boundary_id[f]);
  }
  cloud.on_face.assign(mesh.nodes.size(), 0);
  cloud.face_axis.clear();
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const unsigned int id = mesh.boundary_id[f];
    if (id >= ParticleCloud::n_faces)
      continue;
    while (cloud.face_axis.size() <= id)
      cloud.face_axis.push_back(plane_axis(mesh, cloud.face_axis.size()));
    for (const GlobalIndex a : mesh.boundary_faces[f])
      cloud.on_face[a] |= 1u << id;
  }
}
} // namespace

ParticleCloud make_mesh_cloud(const HexMesh &mesh)
{
  ParticleCloud cloud;
  cloud.position = mesh.nodes;
  add_volumes(mesh, cloud);
  add_faces(mesh, cloud);
  return cloud;
}
} // namespace sabot
