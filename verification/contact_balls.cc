// Elastic balls that meet off their axis without friction, and rigid blocks
// that fall on a rigid wall at a slant: nothing is lost or gained, nothing acts
// along a wall.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/particle_contact.h"
#include "sabot/geometry/round_bodies.h"
#include "verification/meeting.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double R = 5e-3;

struct Balls
{
  bool first_is_cells, second_is_cells;
  double h[2];   // [m]
  double offset; // of their axes over the distance of their centers
  double v = 20., factor = 0.9;
};

std::unique_ptr<Body> ball(const bool is_cells, const int number,
                           const std::array<double, 3> &center, const double h,
                           const double v)
{
  const HexMesh mesh = make_sphere(R, center, h);
  const std::string name = number == 0 ? "first" : "second";
  if (!is_cells)
  {
    SpgOptions options;
    options.initial_velocity = {{0., 0., v}};
    return std::make_unique<SpgBody>(name, number, make_mesh_cloud(mesh),
                                     elastic(0.3), options);
  }
  FemOptions options;
  options.initial_velocity = {{0., 0., v}};
  options.hourglass = "stiffness";
  return std::make_unique<FemBody>(name, number, mesh, elastic(0.3), options);
}

struct Parting
{
  double lost = 0.;    // kinetic energy that the contact took over the first
  double rebound = 0.; // speed along the line of centers over the first
};

Parting meet(const Balls &b)
{
  World world;
  const double distance = 2.03 * R, x = b.offset * distance,
               z = std::sqrt(distance * distance - x * x);
  world.bodies.push_back(
      ball(b.first_is_cells, 0, {{0., 0., 0.}}, b.h[0], b.v));
  world.bodies.push_back(
      ball(b.second_is_cells, 1, {{x, 0., z}}, b.h[1], -b.v));
  if (b.first_is_cells || b.second_is_cells)
  {
    std::vector<ContactPair> pairs;
    if (b.first_is_cells)
      pairs.push_back({0, 1, false});
    if (b.second_is_cells)
      pairs.push_back({1, 0, false});
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
  }
  else
    world.couplings.push_back(std::make_unique<ParticleContact>(
        "contact", world.pointers(), std::vector<std::pair<int, int>>{{0, 1}},
        ContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  // The gap, and the duration of Hertz's contact with what the spring adds.
  while (world.stepper.time() < 1e-5 + 8e-4 / b.v)
    world.advance(b.factor);
  const auto v = world.bodies[0]->measure().velocity,
             w = world.bodies[1]->measure().velocity;
  const double towards = ((w[0] - v[0]) * x + (w[2] - v[2]) * z) / distance;
  return {world.ledger().contact.value() / energy,
          towards / (2. * b.v * z / distance)};
}

std::vector<Check> balls()
{
  std::vector<Check> checks;
  const auto check = [&](const std::string &name, const double least,
                         const std::vector<Balls> &scenes)
  {
    double most = 0., gained = 0., slowest = 1.;
    for (const Balls &scene : scenes)
    {
      const Parting parting = meet(scene);
      most = std::max(most, parting.lost);
      gained = std::max(gained, -parting.lost);
      slowest = std::min(slowest, parting.rebound);
    }
    // Damping of what approaches takes a percent or two, more from coarse
    // bodies, of which a few nodes meet.
    checks.push_back({name + ": energy that contact keeps over the first", 0.,
                      most, 0.03, "1", "a contact without friction is elastic",
                      Check::Kind::at_most});
    checks.push_back({name + ": energy that contact gives over the first", 0.,
                      gained, 0.003, "1", "it gives no more than it took",
                      Check::Kind::at_most});
    checks.push_back({name + ": speed apart over that of closing, least", least,
                      slowest, 0., "1",
                      "elastic, but for vibration and the spin of facets",
                      Check::Kind::at_least});
  };
  const auto pair = [](const bool first, const bool second, const double h1,
                       const double h2, const double offset) {
    return Balls{first, second, {h1, h2}, offset};
  };
  Balls fast = pair(false, false, 0.8e-3, 0.8e-3, 0.5),
        small_steps = pair(false, false, 0.6e-3, 0.8e-3, 0.5);
  fast.v = 200.;
  small_steps.factor = 0.4;
  check("particles", 0.8,
        {pair(false, false, 0.8e-3, 0.8e-3, 0.),
         pair(false, false, 0.6e-3, 0.8e-3, 0.3),
         pair(false, false, 0.6e-3, 0.8e-3, 0.6),
         pair(false, false, 1e-3, 1.3e-3, 0.3), fast, small_steps});
  check("particles and cells", 0.8,
        {pair(true, false, 0.8e-3, 0.8e-3, 0.3),
         pair(true, false, 0.6e-3, 0.8e-3, 0.6),
         pair(false, true, 0.6e-3, 0.8e-3, 0.3)});
  check("cells", 0.8,
        {pair(true, true, 0.8e-3, 0.8e-3, 0.3),
         pair(true, true, 0.6e-3, 0.8e-3, 0.6),
         pair(true, true, 1e-3, 1.3e-3, 0.3)});
  return checks;
}

HexMesh block(const std::array<double, 3> &size, const double h)
{
  BoxSpecification box;
  box.size = size;
  box.cell_size = h;
  return make_graded_box(box);
}

/** A rigid block that is turned about y falls on a rigid wall. */
void fall(const double degrees, const double h, const double factor,
          double &along, double &gained)
{
  const double angle = degrees * M_PI / 180., c = std::cos(angle),
               s = std::sin(angle);
  HexMesh turned = block({{8e-3, 4e-3, 4e-3}}, h), wall;
  for (auto &p : turned.nodes)
    p = {{c * p[0] + s * p[2], p[1],
          c * p[2] - s * p[0] + 4e-3 * s + 2e-3 * c + 0.05e-3}};
  wall = block({{30e-3, 20e-3, 2e-3}}, 1e-3);
  for (auto &p : wall.nodes)
    p[2] -= 1e-3;
  World world;
  RigidOptions falling, fixed;
  falling.initial_velocity = {{0., 0., -50.}};
  fixed.is_prescribed = true;
  world.bodies.push_back(
      std::make_unique<RigidBody>("block", 0, turned, elastic(), falling));
  world.bodies.push_back(
      std::make_unique<RigidBody>("wall", 1, wall, elastic(), fixed));
  start_meeting(world);
  const double energy = world.bodies[0]->measure().kinetic_energy;
  while (world.stepper.time() < 25e-6)
    world.advance(factor);
  const BodyMeasures m = world.bodies[0]->measure();
  along = std::max(
      {along, std::abs(m.velocity[0]) / 50., std::abs(m.velocity[1]) / 50.});
  gained = std::max(gained, m.kinetic_energy / energy - 1.);
}

std::vector<Check> slanted()
{
  double along = 0., gained = 0.;
  for (const double degrees : {1., 3., 10., 20., 45., 70.})
    for (const double h : {0.8e-3, 1.3e-3})
      for (const double factor : {0.9, 0.3})
        fall(degrees, h, factor, along, gained);
  return {{"speed along the wall over that of falling, worst of 24", 0., along,
           1e-9, "1", "nothing acts along a wall without friction"},
          {"energy gained over the first, worst of 24", 0., gained, 1e-3, "1",
           "the wall stands still", Check::Kind::at_most}};
}

const RegisterProblem a({"contact-balls", "elastic balls meet off their axis",
                         "quick", balls}),
    b({"rigid-slanted", "a rigid block falls on a wall at a slant", "quick",
       slanted});
} // namespace
} // namespace sabot
