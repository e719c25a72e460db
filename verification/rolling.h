#ifndef verification_rolling_h
#define verification_rolling_h

#include "sabot/geometry/round_bodies.h"
#include "verification/world.h"

#include <cmath>

namespace sabot
{
constexpr double rolling_radius = 5e-3; // [m]

/** A ball, or a cylinder about y, of the radius R that rests on z = 0. */
inline HexMesh round_mesh(const bool is_ball, const double h)
{
  HexMesh mesh =
      is_ball ? make_sphere(rolling_radius, {{0., 0., 0.}}, h)
              : make_cylinder(rolling_radius, 4e-3, 1, {{0., 0., 0.}}, h);
  // A vertex is not to be below at the start.
  const double angle = 0.1, c = std::cos(angle), s = std::sin(angle);
  double low = 0.;
  for (auto &p : mesh.nodes)
  {
    p = {{c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]}};
    low = std::min(low, p[2]);
  }
  for (auto &p : mesh.nodes)
    p[2] -= low;
  return mesh;
}

/** Of what rolls, body 0 of a world. */
struct RollingState
{
  Vec center = {}, velocity = {};
  double spin = 0., mass = 0., inertia = 0., radius = 0.; // about y
};

inline RollingState rolling_state(const World &world)
{
  const NodalState &n = world.bodies[0]->nodes();
  Vec center = {}, momentum = {};
  RollingState s;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    center += n.inertia[i] * n.position[i];
    momentum += n.inertia[i] * n.velocity[i];
    s.mass += n.inertia[i];
  }
  center *= 1. / s.mass;
  s.velocity = (1. / s.mass) * momentum;
  double l = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec r = n.position[i] - center;
    l += n.inertia[i] * cross(r, n.velocity[i] - s.velocity)[1];
    const double square = r[0] * r[0] + r[2] * r[2];
    s.inertia += n.inertia[i] * square;
    s.radius = std::max(s.radius, std::sqrt(square));
  }
  s.spin = l / s.inertia;
  s.center = center;
  return s;
}
} // namespace sabot

#endif
