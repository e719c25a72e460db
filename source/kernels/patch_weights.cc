// Weights of a smooth pressure on the nodes of a surface.
#include "sabot/kernels/patch_weights.h"

#include "sabot/kernels/kernel_function.h"

#include <Eigen/Dense>

#include <cmath>

namespace sabot
{
bool patch_weights(const std::vector<Vec> &point,
                   const std::vector<double> &area, const Vec center,
                   const Vec normal, const double radius,
                   std::vector<double> &weight)
{
  constexpr double largest_pull = 0.1;
  const Vec across =
      std::abs(normal[0]) < 0.7 ? vec(1., 0., 0.) : vec(0., 1., 0.);
  Vec first = across - dot(across, normal) * normal;
  first = (1. / norm(first)) * first;
  const Vec second = cross(normal, first);
  const std::size_t n = point.size();
  weight.resize(n);
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < n; ++a)
  {
    const Vec offset = (1. / radius) * (point[a] - center);
    weight[a] = cubic_spline(norm(offset)) * area[a];
    const Eigen::Vector3d p(1., dot(offset, first), dot(offset, second));
    M += weight[a] * p * p.transpose();
  }
  const double scale = M(0, 0);
  if (!(scale > 0.) || !(M.determinant() > 1e-5 * scale * scale * scale))
    return false;
  const Eigen::Vector3d c = M.inverse().col(0);
  for (std::size_t a = 0; a < n; ++a)
  {
    const Vec offset = (1. / radius) * (point[a] - center);
    weight[a] *= c[0] + c[1] * dot(offset, first) + c[2] * dot(offset, second);
    if (weight[a] < -largest_pull)
      return false;
  }
  return true;
}
} // namespace sabot
