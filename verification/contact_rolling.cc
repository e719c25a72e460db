// Balls and cylinders of facets that slide, roll and graze as round ones do.
#include "verification/heavy.h"
#include "verification/problem.h"
#include "verification/rolling.h"

#include <cstdio>

namespace sabot
{
namespace
{
/** What rolls on a flat rigid wall, whose upper face is z = 0, in the direction
    x, under a weight that grows within a fifth of the time. */
struct Rolling
{
  bool is_ball = true, is_rigid = true;
  double h = 1e-3, wall = 1e-3; // [m]
  double mu = 0.;
  double v = 50., g = 1e6, end = 200e-6;
  double factor = 0.9;
};

void add_round(World &world, const Rolling &s)
{
  const Vec gravity = vec(0., 0., -s.g);
  if (s.is_rigid)
  {
    RigidOptions options;
    options.initial_velocity = {{s.v, 0., 0.}};
    world.bodies.push_back(std::make_unique<Heavy<RigidBody>>(
        gravity, 0.2 * s.end, "round", 0, round_mesh(s.is_ball, s.h), elastic(),
        options));
    return;
  }
  FemOptions options;
  options.initial_velocity = {{s.v, 0., 0.}};
  options.hourglass = "stiffness";
  world.bodies.push_back(std::make_unique<Heavy<FemBody>>(
      gravity, 0.2 * s.end, "round", 0, round_mesh(s.is_ball, s.h), elastic(),
      options));
}

struct Ride
{
  double velocity = 0., sideways = 0., spin = 0.; // over the first speed
  double rolling = 0.; // 1/(1 + I/(m R^2)) of the nodes' masses
  // Over the second half of the time.
  double mean_velocity = 0., mean_spin = 0.;
  double mean = 0., ripple = 0.; // of the force over the weight
};

Ride ride(const Rolling &s)
{
  World world;
  add_round(world, s);
  BoxSpecification b;
  b.size = {{s.v * s.end + 8e-3, 10e-3, 2e-3}};
  b.center = {{0.5 * s.v * s.end, 0.1e-3, -1e-3}};
  b.cell_size = s.wall;
  start_on(world, "wall", make_graded_box(b), s.mu);
  double sum = 0., square = 0., time = 0.;
  Ride r;
  while (world.stepper.time() < s.end)
  {
    const double dt = world.advance(s.factor);
    const RollingState now = rolling_state(world);
    double f = 0.;
    for (const Resultant &r : world.couplings[0]->resultants())
      if (r.body == 0)
        f += r.force[2] / (now.mass * s.g);
    if (world.stepper.time() > 0.5 * s.end)
    {
      sum += f * dt;
      square += f * f * dt;
      time += dt;
      r.mean_velocity += dt * now.velocity[0] / s.v;
      r.mean_spin += dt * now.spin * now.radius / s.v;
    }
  }
  const RollingState last = rolling_state(world);
  r.rolling =
      1. / (1. + last.inertia / (last.mass * last.radius * last.radius));
  r.velocity = last.velocity[0] / s.v;
  r.sideways = last.velocity[1] / s.v;
  r.spin = last.spin * last.radius / s.v;
  r.mean_velocity /= time;
  r.mean_spin /= time;
  r.mean = sum / time;
  r.ripple = std::sqrt(std::max(0., square / time - r.mean * r.mean));
  return r;
}

void check_sliding(std::vector<Check> &checks, const std::string &what,
                   const Rolling &s)
{
  const Ride r = ride(s);
  // Nodes and facets alone: ripple of 0.11 to 0.74, 0.02 to 0.3 of the speed as
  // spin.
  checks.push_back({what + "no friction: speed over the first", 1., r.velocity,
                    1e-9, "1", "nothing acts along"});
  checks.push_back({what + "no friction: sideways over the first", 0.,
                    r.sideways, 1e-9, "1", "nothing acts along"});
  checks.push_back({what + "no friction: spin times radius over the speed", 0.,
                    r.spin, 0.025, "1", "it presses below the center"});
  checks.push_back({what + "no friction: mean force over the weight", 1.,
                    r.mean, 0.02, "1", "its height stays"});
  checks.push_back({what + "no friction: ripple of the force over the weight",
                    0., r.ripple, 0.25, "1", "round"});
}

void check_rolling(std::vector<Check> &checks, const std::string &what,
                   Rolling s)
{
  s.mu = 0.5;
  const Ride r = ride(s);
  // What sticks is a spring, and the ball swings on it. Friction acts on the
  // facets, whose middle is up to 2 % nearer to the center.
  checks.push_back({what + "mean speed once it rolls over the first", r.rolling,
                    r.mean_velocity, 0.035 * r.rolling, "1",
                    s.is_ball ? "1/(1 + I/(m R^2)), 5/7 of a fine mesh"
                              : "1/(1 + I/(m R^2)), 2/3 of a fine mesh"});
  checks.push_back({what + "mean spin times radius over that", 1.,
                    r.mean_spin / r.mean_velocity, 0.03, "1", "it rolls"});
  // Nodes and facets alone: 1.2 to 3.0, they hop.
  checks.push_back({what + "rolling: ripple of the force over the weight", 0.,
                    r.ripple, 0.4, "1", "round"});
  checks.push_back({what + "sideways over the first", 0., r.sideways, 0.02, "1",
                    "symmetry"});
}

std::vector<Check> rolling(const std::vector<double> &sizes)
{
  std::vector<Check> checks;
  for (const bool is_ball : {true, false})
    for (const bool is_rigid : {true, false})
      for (const double h : sizes)
      {
        Rolling s;
        s.is_ball = is_ball;
        s.is_rigid = is_rigid;
        s.h = h;
        char what[60];
        std::snprintf(what, sizeof(what), "%s %s, %.1f mm, ",
                      is_rigid ? "rigid" : "elastic",
                      is_ball ? "ball" : "cylinder", 1e3 * h);
        check_sliding(checks, what, s);
        check_rolling(checks, what, s);
      }
  return checks;
}

std::vector<Check> rolling_quick()
{
  return rolling({1.2e-3});
}

std::vector<Check> rolling_long()
{
  return rolling({0.5e-3, 0.8e-3, 1.2e-3});
}

const RegisterProblem a({"contact-rolling",
                         "balls and cylinders slide and roll on a flat wall",
                         "quick", rolling_quick}),
    b({"contact-rolling-long",
       "balls and cylinders slide and roll on a flat wall: three meshes",
       "long", rolling_long});
} // namespace
} // namespace sabot
