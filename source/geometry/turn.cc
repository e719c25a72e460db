// Rotations of bodies, and what they do to meshes and clouds.
#include "sabot/geometry/turn.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/geometry/hex_mesh.h"
#include "sabot/geometry/particle_cloud.h"

#include <cmath>

namespace sabot
{
namespace
{
Vec to_vec(const std::array<double, 3> &x)
{
  return vec(x[0], x[1], x[2]);
}

std::array<double, 3> to_array(const Vec x)
{
  return {{x[0], x[1], x[2]}};
}

/** Entries next to 0 and +-1 become these. */
Mat without_round_off(Mat m)
{
  constexpr double round_off = 1e-14;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(m(i, j) - std::round(m(i, j))) < round_off)
        m.set(i, j, std::round(m(i, j)) + 0.); // no negative zeros
  return m;
}

/** By Rodrigues, about a unit vector @p n. */
Mat rotation_about(const Vec n, const double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  Mat m = c * Mat::identity();
  add_outer(m, (1. - c) * n, n);
  return m + s * Mat{{vec(0., -n[2], n[1]), vec(n[2], 0., -n[0]),
                      vec(-n[1], n[0], 0.)}};
}

/** The axis that @p v points along; nothing where it does not. */
std::optional<int> axis_along(const Vec v)
{
  for (int d = 0; d < 3; ++d)
    if (std::abs(v[d]) > (1. - 1e-12) * norm(v))
      return d;
  return std::nullopt;
}
} // namespace

Turn::Turn(const Mat &m, const std::array<double, 3> &center)
    : none(false), rotation(without_round_off(m)), center(to_vec(center))
{
}

Turn Turn::about(const std::array<double, 3> &axis, const double angle,
                 const std::array<double, 3> &center)
{
  const Vec n = to_vec(axis);
  return Turn(rotation_about((1. / norm(n)) * n, angle), center);
}

Turn Turn::by_angles(const double yaw, const double pitch, const double roll,
                     const std::array<double, 3> &center)
{
  return Turn(rotation_about(vec(0., 0., 1.), yaw) *
                  rotation_about(vec(0., 1., 0.), pitch) *
                  rotation_about(vec(1., 0., 0.), roll),
              center);
}

void Turn::declare(Parameters &prm)
{
  constexpr double most = 1e3; // [rad]
  prm.declare_entry("Rotation axis", "0, 0, 1",
                    quantities(Dimension::none, 3, 3, -1e6, 1e6),
                    "Direction about which the body is turned; its length does "
                    "not matter.");
  prm.declare_entry("Rotation angle", "0 deg",
                    quantity(Dimension::angle, -most, most),
                    "Angle by which it is turned, by the right-hand rule. "
                    "Faces keep their names: they are the body's.");
  prm.declare_entry("Yaw pitch roll", "0 deg, 0 deg, 0 deg",
                    quantities(Dimension::angle, 3, 3, -most, most),
                    "Instead of axis and angle: the body is turned by the last "
                    "about x, then by the second about y, then by the first "
                    "about z, all fixed axes.");
  prm.declare_entry(
      "Rotation center", "center",
      word_or("center", quantities(Dimension::length, 3, 3, -1e3, 1e3)),
      "Point about which the body is turned; center: its "
      "\"Center\". With the point of impact, the path of a "
      "projectile turns with it.");
}

Turn Turn::parse(const Parameters &prm, const std::string &path)
{
  const double angle = get_quantity(prm, "Rotation angle");
  const auto ypr = get_vector(prm, "Yaw pitch roll");
  const bool has_angles = ypr[0] != 0. || ypr[1] != 0. || ypr[2] != 0.;
  const auto center = get_vector(prm, prm.get("Rotation center") == "center"
                                          ? "Center"
                                          : "Rotation center");
  const auto axis = get_vector(prm, "Rotation axis");
  if (angle != 0. && has_angles)
    throw InputError(path + "/Yaw pitch roll",
                     "and \"Rotation angle\" are both set; give the rotation "
                     "in one of the two ways");
  if (norm(to_vec(axis)) == 0.)
    throw InputError(path + "/Rotation axis",
                     "is 0, 0, 0, which is no direction; give a vector");
  if (angle != 0.)
    return about(axis, angle, center);
  return has_angles ? by_angles(ypr[0], ypr[1], ypr[2], center) : Turn();
}

std::array<double, 3> Turn::place(const std::array<double, 3> &point) const
{
  return to_array(center + rotation * (to_vec(point) - center));
}

std::array<double, 3> Turn::origin(const std::array<double, 3> &place) const
{
  return to_array(center + transpose(rotation) * (to_vec(place) - center));
}

void Turn::apply(HexMesh &mesh) const
{
  if (none)
    return;
  for (auto &node : mesh.nodes)
    node = place(node);
}

void Turn::apply(ParticleCloud &cloud) const
{
  if (none)
    return;
  for (auto &position : cloud.position)
    position = place(position);
  // Of a face that was a plane all areas point one way.
  std::vector<Vec> normal(cloud.face_axis.size(), Vec{});
  for (ParticleCloud::FaceShare &share : cloud.face_shares)
  {
    share.area = rotation * share.area;
    if (share.id < normal.size())
      normal[share.id] += share.area;
  }
  for (std::size_t id = 0; id < normal.size(); ++id)
    if (cloud.face_axis[id])
      cloud.face_axis[id] = axis_along(normal[id]);
  if (cloud.shape.empty())
  {
    const auto &h = cloud.spacing;
    cloud.shape.assign(
        cloud.position.size(),
        Mat{{vec(h[0], 0., 0.), vec(0., h[1], 0.), vec(0., 0., h[2])}});
    cloud.spacing.fill(std::cbrt(h[0] * h[1] * h[2]));
  }
  for (Mat &shape : cloud.shape)
    shape = rotation * shape;
}
} // namespace sabot
