// What is round rolls and slides in troughs, over hills and down slopes, and
// loses nothing.
#include "verification/heavy.h"
#include "verification/problem.h"
#include "verification/rolling.h"

#include <cstdio>

namespace sabot
{
namespace
{
/** A track that is bent about y, and what moves on it from its start, where it
    points along x. */
struct Track
{
  const char *name;
  double bend; // of a trough the inverse radius, negative of a hill [1/m]
  double tilt; // of the weight, which pulls along by its sine
  double v, mu;
  bool is_ball = true, is_rigid = true;
  double h = 1e-3, wall = 1e-3, factor = 0.9;
};

constexpr double weight = 3e5, end = 300e-6, rise = 20e-6;

HexMesh track_mesh(const Track &t)
{
  BoxSpecification b;
  b.size = {{24e-3, 10e-3, 2e-3}};
  b.center = {{6e-3, 0.1e-3, -1e-3}};
  b.cell_size = t.wall;
  HexMesh mesh = make_graded_box(b);
  if (t.bend == 0.)
    return mesh;
  const double radius = 1. / t.bend;
  for (auto &p : mesh.nodes)
  {
    const double angle = p[0] * t.bend;
    p = {{(radius - p[2]) * std::sin(angle), p[1],
          radius - (radius - p[2]) * std::cos(angle)}};
  }
  return mesh;
}

template <typename Kind, typename Options>
void add_rider(World &world, const Track &t, Options options)
{
  options.initial_velocity = {{t.v, 0., 0.}};
  HexMesh mesh = round_mesh(t.is_ball, t.h);
  // Chords of a trough stand out from it.
  for (auto &p : mesh.nodes)
    p[2] += 0.125 * t.wall * t.wall * std::max(0., t.bend);
  world.bodies.push_back(std::make_unique<Heavy<Kind>>(
      weight * vec(std::sin(t.tilt), 0., -std::cos(t.tilt)), rise, "round", 0,
      mesh, elastic(), options));
}

void build(World &world, const Track &t)
{
  if (t.is_rigid)
    add_rider<RigidBody>(world, t, RigidOptions());
  else
  {
    FemOptions options;
    options.hourglass = "stiffness";
    add_rider<FemBody>(world, t, options);
  }
  start_on(world, "track", track_mesh(t), t.mu);
}

struct Result
{
  double energy = 0.;   // of motion over what it had and the weight gave
  double spin = 0.;     // times radius, over the speed
  double sideways = 0.; // over the speed
  double mean = 0., ripple = 0.; // of the force over that of the exact track
  double speed = 0.;             // [m/s]
};

double energy_of(const RollingState &s)
{
  return 0.5 *
         (s.mass * dot(s.velocity, s.velocity) + s.inertia * s.spin * s.spin);
}

/** Pressing force on the exact track [N]. */
double exact_force(const Track &t, const RollingState &s)
{
  Vec n = vec(0., 0., 1.);
  double turning = 0.;
  if (t.bend != 0.)
  {
    Vec to_middle = vec(0., 0., 1. / t.bend) - s.center;
    to_middle[1] = 0.;
    const double distance = norm(to_middle);
    n = (t.bend > 0. ? 1. / distance : -1. / distance) * to_middle;
    turning =
        dot(s.velocity, s.velocity) / (t.bend > 0. ? distance : -distance);
  }
  const Vec down = weight * vec(std::sin(t.tilt), 0., -std::cos(t.tilt));
  return s.mass * (turning - dot(down, n));
}

Result ride(const Track &t)
{
  World world;
  build(world, t);
  const RollingState first = rolling_state(world);
  const Vec down = weight * vec(std::sin(t.tilt), 0., -std::cos(t.tilt));
  double work = 0., sum = 0., square = 0., time = 0.;
  RollingState before = first;
  while (world.stepper.time() < end)
  {
    const double dt = world.advance(t.factor), now_time = world.stepper.time();
    const RollingState now = rolling_state(world);
    work += std::min(1., (now_time - 0.5 * dt) / rise) * now.mass *
            dot(down, now.center - before.center);
    before = now;
    if (now_time < 0.5 * end)
      continue;
    Vec force = {};
    for (const Resultant &r : world.couplings[0]->resultants())
      if (r.body == 0)
        force = vec(r.force[0], r.force[1], r.force[2]);
    const double f = norm(force) / exact_force(t, now);
    sum += f * dt;
    square += f * f * dt;
    time += dt;
  }
  Result r;
  r.speed = norm(before.velocity);
  r.energy = energy_of(before) / (energy_of(first) + work);
  r.spin = before.spin * before.radius / r.speed;
  r.sideways = before.velocity[1] / r.speed;
  r.mean = sum / time;
  r.ripple = std::sqrt(std::max(0., square / time - r.mean * r.mean));
  return r;
}

void check_ride(std::vector<Check> &checks, const Track &t)
{
  const Result r = ride(t);
  char text[80];
  std::snprintf(text, sizeof(text), "%s %s, %s, ",
                t.is_rigid ? "rigid" : "elastic",
                t.is_ball ? "ball" : "cylinder", t.name);
  const std::string what = text;
  checks.push_back(
      {what + "energy over that which the weight gave", 1., r.energy,
       t.mu > 0. ? 0.03 : 0.003, "1",
       t.mu > 0. ? "what sticks takes nothing" : "nothing takes any"});
  checks.push_back(
      {what + "spin times radius over the speed", t.mu > 0. ? 1. : 0., r.spin,
       t.mu > 0. ? 0.03 : 0.01, "1",
       t.mu > 0. ? "it rolls" : "it presses below the center, but for facets"});
  checks.push_back({what + "sideways over the speed", 0., r.sideways, 0.02, "1",
                    "symmetry"});
  checks.push_back({what + "mean force over that of the exact track", 1.,
                    r.mean, 0.03, "1", "m (g . n + v^2/r)"});
  checks.push_back({what + "ripple of the force", 0., r.ripple, 0.5, "1",
                    "light, on facets", Check::Kind::at_most});
}

// From rest with friction: a = g sin/(1 + I/(m R^2)) along the slope.
const Track slope = {"slope", 0., 0.3, 0., 0.5},
            trough = {"trough", 60., 0.3, 0., 0.5},
            hill = {"hill", -60., 0.3, 0., 0.5},
            slippery = {"hill without friction", -30., 0., 30., 0.};

Track with(Track track, const bool is_ball, const bool is_rigid)
{
  track.is_ball = is_ball;
  track.is_rigid = is_rigid;
  return track;
}

std::vector<Check> tracks_quick()
{
  std::vector<Check> checks;
  check_ride(checks, with(slope, true, false));
  check_ride(checks, with(trough, false, false));
  check_ride(checks, with(slippery, true, true));
  check_ride(checks, with(slippery, false, true));
  return checks;
}

std::vector<Check> tracks_long()
{
  std::vector<Check> checks;
  for (const Track &track : {slope, trough, hill})
    for (const bool is_ball : {true, false})
      check_ride(checks, with(track, is_ball, false));
  for (const bool is_rigid : {true, false})
    for (const bool is_ball : {true, false})
      check_ride(checks, with(slippery, is_ball, is_rigid));
  return checks;
}

const RegisterProblem a({"contact-tracks",
                         "what is round rolls in troughs and down slopes",
                         "quick", tracks_quick}),
    b({"contact-tracks-long",
       "what is round rolls in troughs, over hills and down slopes", "long",
       tracks_long});
} // namespace
} // namespace sabot
