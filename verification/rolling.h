#ifndef verification_rolling_h
#define verification_rolling_h

#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/geometry/round_bodies.h"
#include "verification/metals.h"
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

/** Adds what body 0 of a world moves on, fixed, and their contact with friction
    @p mu; then the world starts. */
inline void start_on(World &world, const std::string &name, const HexMesh &mesh,
                     const double mu)
{
  RigidOptions fixed;
  fixed.is_prescribed = true;
  world.bodies.push_back(
      std::make_unique<RigidBody>(name, 1, mesh, elastic(), fixed));
  ContactOptions options;
  if (mu > 0.)
    options.friction = coulomb(mu);
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, options,
      MPI_COMM_WORLD));
  world.couplings.push_back(std::make_unique<ClosingLimit>(
      world.pointers(), world.couplings, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
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
