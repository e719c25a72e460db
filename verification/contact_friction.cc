// Friction on flat walls: Coulomb's share of what presses at any step, and
// nothing that creeps; balls that graze, spin and roll.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/geometry/round_bodies.h"
#include "verification/heavy.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
HexMesh brick(const std::array<double, 3> &size,
              const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return make_graded_box(b);
}

/** A rigid wall of cells of the width @p h below z = 0. */
void add_wall(World &world, const double h)
{
  RigidOptions options;
  options.is_prescribed = true;
  world.bodies.push_back(std::make_unique<RigidBody>(
      "wall", 1, brick({{24e-3, 12e-3, 2e-3}}, {{5e-3, 0., -1e-3}}, h),
      elastic(), options));
}

/** What is on the wall, of cells (B-bar) or particles. */
void add_body(World &world, const bool particles, const HexMesh &mesh,
              const Vec gravity = Vec{}, const double rise = 0.)
{
  if (particles)
  {
    world.bodies.push_back(std::make_unique<Heavy<SpgBody>>(
        gravity, rise, "body", 0, make_mesh_cloud(mesh), elastic(),
        SpgOptions()));
    return;
  }
  FemOptions options;
  options.integration = "B-bar";
  world.bodies.push_back(std::make_unique<Heavy<FemBody>>(
      gravity, rise, "body", 0, mesh, elastic(), options));
}

/** Both sides' nodes are held; the first body starts with @p velocity and turns
    with @p spin [1/s] about its center. */
void start(World &world, const bool particles, const double mu,
           const Vec velocity, const Vec spin = Vec{})
{
  ContactOptions options;
  if (mu > 0.)
    options.friction = coulomb(mu);
  std::vector<ContactPair> pairs = {{1, 0, false}};
  if (!particles)
    pairs.push_back({0, 1, false});
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), pairs, options, MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = world.bodies[0]->nodes();
  Vec center = {};
  double mass = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    center += n.inertia[i] * n.position[i];
    mass += n.inertia[i];
  }
  center *= 1. / mass;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = velocity + cross(spin, n.position[i] - center);
  world.bodies[0]->update_ghosts();
  world.stepper.initialize();
}

constexpr double R = 5e-3; // of balls [m]

HexMesh ball(const double h, const double gap)
{
  HexMesh mesh = make_sphere(R, {{0., 0., 0.}}, h);
  double low = 0.;
  for (const auto &p : mesh.nodes)
    low = std::min(low, p[2]);
  for (auto &p : mesh.nodes)
    p[2] += gap - low;
  return mesh;
}

/** Change of velocity along over that across, of a ball of 5 mm that comes in
    at 20 m/s down and 100 m/s along, with @p spin; sideways in y. */
std::array<double, 2> graze(const bool particles, const double h,
                            const double wall, const double factor,
                            const double mu, const Vec velocity, const Vec spin)
{
  World world;
  add_body(world, particles, ball(h, 0.01e-3));
  add_wall(world, wall);
  start(world, particles, mu, velocity, spin);
  while (world.stepper.time() < 45e-6)
    world.advance(factor);
  const auto v = world.bodies[0]->measure().velocity;
  const double across = v[2] - velocity[2];
  return {{(velocity[0] - v[0]) / across, (velocity[1] - v[1]) / across}};
}

std::vector<Check> impulse()
{
  const double mu = 0.3;
  std::vector<Check> checks;
  const auto add = [&](const bool particles, const double h, const double wall,
                       const double factor)
  {
    char where[80];
    std::snprintf(where, sizeof(where),
                  "%s, steps of %.1f: ", particles ? "particles" : "cells",
                  factor);
    const Vec v = vec(100., 0., -20.), down = vec(0., 0., -20.);
    // A spin about y turns the lowest point along -x.
    const auto grazes = graze(particles, h, wall, factor, mu, v, Vec{}),
               spins = graze(particles, h, wall, factor, mu, down,
                             vec(0., 2e4, 0.));
    checks.push_back({std::string(where) + "grazing, along over across", mu,
                      grazes[0], 0.02 * mu, "1", "Coulomb"});
    checks.push_back({std::string(where) + "grazing, sideways over across", 0.,
                      grazes[1], 0.002 * mu, "1", "symmetry"});
    checks.push_back({std::string(where) + "spinning, along over across", -mu,
                      spins[0], 0.02 * mu, "1", "Coulomb"});
  };
  for (const double factor : {0.3, 0.9})
    add(false, 1.25e-3, 1e-3, factor);
  add(false, 1.25e-3, 0.6e-3, 0.9);
  for (const double factor : {0.3, 0.9})
    add(true, 1.25e-3, 1e-3, factor);
  return checks;
}

/** A block of 2 x 2 x 1 mm on a slope with a tangent of @p ratio times the
    friction, under a weight that grows within 1 ms if it sticks.
    @return the way down the slope in the second half of the steps, and in all
    over that of free sliding. */
std::array<double, 2> way_down(const bool particles, const double ratio,
                               const int n_steps)
{
  const double mu = 0.3, g = 1e4, angle = std::atan(ratio * mu);
  World world;
  add_body(world, particles,
           brick({{2e-3, 2e-3, 1e-3}}, {{0.2e-3, 0.1e-3, 0.5e-3}}, 1e-3),
           vec(g * std::sin(angle), 0., -g * std::cos(angle)),
           ratio < 1. ? 1e-3 : 0.);
  add_wall(world, 1.3e-3);
  start(world, particles, mu, Vec{});
  const auto mean_x = [&]
  {
    const NodalState &n = world.bodies[0]->nodes();
    double sum = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      sum += n.position[i][0];
    return sum / n.n_owned;
  };
  const double first = mean_x();
  double half_way = first;
  for (int step = 1; step <= n_steps; ++step)
  {
    world.advance(0.9);
    if (step == n_steps / 2)
      half_way = mean_x();
  }
  const double t = world.stepper.time();
  return {{mean_x() - half_way,
           (mean_x() - first) /
               (0.5 * g * t * t * (std::sin(angle) - mu * std::cos(angle)))}};
}

std::vector<Check> on_slope(const int n_of_cells, const int n_of_particles)
{
  std::vector<Check> checks;
  for (const bool particles : {false, true})
  {
    const std::string what = particles ? "particles, " : "cells, ";
    const int n = particles ? n_of_particles : n_of_cells;
    // A millionth of the spacing; free fall would be 20 to 130 mm.
    checks.push_back({what + "below the angle, creep in the second half of " +
                          std::to_string(n) + " steps",
                      0., way_down(particles, 0.8, n)[0], 1e-9, "m",
                      "it sticks"});
    checks.push_back({what + "above the angle, way over that of free sliding",
                      1., way_down(particles, 1.2, 10000)[1], 0.01, "1",
                      "g (sin - mu cos) t^2/2"});
  }
  return checks;
}

std::vector<Check> slope()
{
  return on_slope(100000, 20000);
}

std::vector<Check> slope_long()
{
  return on_slope(200000, 100000);
}

/** A block under its weight slides to rest. */
std::vector<Check> stop()
{
  const double mu = 0.2, v = 20., g = 1e6;
  std::vector<Check> checks;
  for (const double factor : {0.1, 0.5, 0.9})
  {
    World world;
    add_body(world, false,
             brick({{4e-3, 3e-3, 2e-3}}, {{-1e-3, 0., 1e-3}}, 1e-3),
             vec(0., 0., -g));
    add_wall(world, 1.3e-3);
    start(world, false, mu, vec(v, 0., 0.));
    double x = 0.;
    while (world.stepper.time() < 1.3 * v / (mu * g))
    {
      const double dt = world.advance(factor);
      x += dt * world.bodies[0]->measure().velocity[0];
    }
    char where[40];
    std::snprintf(where, sizeof(where), "steps of %.1f: ", factor);
    checks.push_back({std::string(where) + "sliding distance",
                      v * v / (2. * mu * g), x, 0.01 * v * v / (2. * mu * g),
                      "m", "v^2/(2 mu g)"});
  }
  return checks;
}

const RegisterProblem a({"contact-friction-impulse",
                         "balls graze and spin on a wall", "quick", impulse}),
    b({"contact-slope", "blocks on a slope below and above the angle", "quick",
       slope}),
    d({"contact-slope-long", "the same for more steps", "long", slope_long}),
    c({"contact-friction-stop", "a block slides to rest", "quick", stop});
} // namespace
} // namespace sabot
