// Contact of bars of cells and of particles: the impact of St-Venant, and edges
// that are aligned.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/particle_contact.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{

/** What the two bodies that meet are made of; cells meet cells or particles. */
enum class Pairing
{
  cells,
  cells_particles,
  particles
};

std::string name_of(const Pairing pairing)
{
  return pairing == Pairing::cells             ? "cells on cells: "
         : pairing == Pairing::cells_particles ? "cells on particles: "
                                               : "particles on particles: ";
}

void add_box(World &world, const bool particles,
             const std::array<double, 3> &size,
             const std::array<double, 3> &center,
             const std::array<double, 3> &velocity, const double nu,
             const double h = 1e-3)
{
  const int id = world.bodies.size();
  const std::string name = "body" + std::to_string(id);
  if (particles)
  {
    SpgOptions options;
    options.initial_velocity = velocity;
    world.bodies.push_back(std::make_unique<SpgBody>(
        name, id, make_box_cloud(center, size, h), elastic(nu), options));
    return;
  }
  FemOptions options;
  options.initial_velocity = velocity;
  BoxSpecification box;
  box.size = size;
  box.center = center;
  box.cell_size = h;
  world.bodies.push_back(std::make_unique<FemBody>(
      name, id, make_graded_box(box), elastic(nu), options));
}

void add_contact(World &world, const Pairing pairing)
{
  const ContactOptions options;
  if (pairing == Pairing::particles)
    world.couplings.push_back(std::make_unique<ParticleContact>(
        "contact", world.pointers(), std::vector<std::pair<int, int>>{{0, 1}},
        options, MPI_COMM_WORLD));
  else
  {
    std::vector<ContactPair> pairs = {{0, 1, false}};
    if (pairing == Pairing::cells)
      pairs.push_back({1, 0, false});
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), pairs, options, MPI_COMM_WORLD));
  }
  world.distribute();
  world.stepper.initialize();
}

/** A bar strikes an equal one; nu = 0 so that one dimension is exact. */
std::vector<Check> impact_of_bars(const Pairing pairing)
{
  const double rho = aluminum().density,
               c = std::sqrt(aluminum().young_modulus / rho);
  const double length = 100e-3, w = 2e-3, v = 10.;
  World world;
  add_box(world, pairing == Pairing::particles, {{length, w, w}},
          {{-0.5 * length, 0, 0}}, {{v, 0, 0}}, 0.);
  add_box(world, pairing != Pairing::cells, {{length, w, w}},
          {{0.5 * length, 0, 0}}, {{0, 0, 0}}, 0.);
  add_contact(world, pairing);
  const double energy = world.total_energy(), momentum = world.momenta()[0];
  const double mass = world.bodies[1]->measure().mass;
  double early = std::nan(""), late = early, parted = early, old = 0.,
         old_time = 0.;
  const auto end_speed = [&](const int b)
  {
    const NodalState &n = world.bodies[b]->nodes();
    double sum = 0.;
    int count = 0;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (std::abs(n.reference_position[i][0]) < 1e-9)
      {
        sum += n.velocity[i][0];
        ++count;
      }
    return sum / count;
  };
  while (world.stepper.time() < 3. * length / c)
  {
    world.advance(0.5);
    const double t = world.stepper.time(),
                 p = mass * world.bodies[1]->measure().velocity[0];
    // The force is the slope of the momentum.
    if (std::isnan(early) && t > 0.5 * length / c)
    {
      early = p;
      old_time = t;
    }
    if (std::isnan(late) && t > 1.5 * length / c)
    {
      late = p;
      old = t;
    }
    if (std::isnan(parted) && t > length / c &&
        end_speed(1) - end_speed(0) > 0.5 * v)
      parted = t;
  }
  const double stress = (late - early) / (old - old_time) / (w * w),
               exact = 0.5 * rho * c * v;
  const std::string what = name_of(pairing);
  return {{what + "stress", exact, stress, 0.01 * exact, "Pa",
           "rho c v/2 (St-Venant)"},
          {what + "contact time", 2. * length / c, parted,
           0.03 * 2. * length / c, "s", "2 L/c"},
          {what + "velocity of the struck bar", v,
           world.bodies[1]->measure().velocity[0], 0.01 * v, "m/s",
           "equal bars exchange velocities"},
          {what + "momentum after over before, less one", 0.,
           world.momenta()[0] / momentum - 1., 1e-12, "1", "conservation"},
          {what + "energy change", 0., world.total_energy() / energy - 1., 1e-3,
           "1", "energy balance"}};
}

std::vector<Check> bars()
{
  std::vector<Check> checks = impact_of_bars(Pairing::cells);
  for (const Check &check : impact_of_bars(Pairing::cells_particles))
    checks.push_back(check);
  return checks;
}

std::vector<Check> particle_bars()
{
  return impact_of_bars(Pairing::particles);
}

/** A cube of 4 mm, off the lattice of the slab of 9 x 9 x 4 mm that it
    strikes. */
struct Strike
{
  double rebound = 0., deepest = 0., angular = 0., momentum = 0., gain = 0.,
         highest = 0.;
};

Strike strike(const Pairing pairing, const double h)
{
  const double v = 50., nu = 0.33;
  World world;
  add_box(world, pairing == Pairing::particles, {{4e-3, 4e-3, 4e-3}},
          {{0.2e-3, 0.3e-3, 2.01e-3}}, {{0, 0, -v}}, nu, h);
  add_box(world, pairing != Pairing::cells, {{9e-3, 9e-3, 4e-3}},
          {{0, 0, -2e-3}}, {{0, 0, 0}}, nu, h);
  add_contact(world, pairing);
  const double energy = world.total_energy();
  const auto before = world.momenta();
  Strike result;
  while (world.stepper.time() < 15e-6)
  {
    world.advance(0.9);
    result.highest =
        std::max(result.highest, world.total_energy() / energy - 1.);
  }
  const auto after = world.momenta();
  for (int d = 0; d < 3; ++d)
  {
    result.momentum =
        std::max(result.momentum, std::abs((after[d] - before[d]) / before[2]));
    result.angular =
        std::max(result.angular,
                 std::abs((after[3 + d] - before[3 + d]) / (before[2] * 2e-3)));
  }
  result.gain = world.total_energy() / energy - 1.;
  result.rebound = world.bodies[0]->measure().velocity[2] / v;
  for (const Measure &m : world.couplings[0]->measure())
    if (m.name == "penetration max over spacing")
      result.deepest = m.value;
  return result;
}

std::vector<Check> blocks()
{
  std::vector<Check> checks;
  for (const double h : {1e-3, 0.5e-3})
  {
    double reference = 0.;
    for (const Pairing pairing :
         {Pairing::cells, Pairing::cells_particles, Pairing::particles})
    {
      const Strike s = strike(pairing, h);
      char text[80];
      std::snprintf(text, sizeof(text), "%.1f mm, ", h * 1e3);
      const std::string what = text + name_of(pairing);
      if (pairing == Pairing::cells)
        reference = s.rebound;
      checks.push_back({what + "velocity after over before", reference,
                        s.rebound, 0.05, "1", "cells on cells",
                        h < 1e-3 ? Check::Kind::near : Check::Kind::reported});
      checks.push_back({what + "momentum, change over the first", 0.,
                        s.momentum, 1e-12, "1", "equal and opposite forces"});
      checks.push_back({what + "angular momentum, change over m v 2 mm", 0.,
                        s.angular, 1e-2, "1", "exact but for rims"});
      // What is left is the particles' ledger at steps of 0.9.
      checks.push_back(
          {what + "gain of energy after parting", 0., s.gain, 1e-3, "1",
           "energy balance",
           h < 1e-3 ? Check::Kind::at_most : Check::Kind::reported});
      checks.push_back(
          {what + "highest energy between", 0., s.highest, 2e-3, "1",
           "energy balance",
           h < 1e-3 ? Check::Kind::at_most : Check::Kind::reported});
      checks.push_back({what + "penetration over spacing", 0.1, s.deepest, 0.,
                        "1", "K h against the stable step",
                        Check::Kind::at_most});
    }
  }
  return checks;
}

const RegisterProblem a({"contact-bars", "St-Venant impact, also on particles",
                         "quick", bars}),
    b({"contact-particle-bars", "St-Venant impact of particles on particles",
       "quick", particle_bars}),
    c({"contact-particle-blocks",
       "a block strikes a slab: particles against hexahedra", "quick", blocks});
} // namespace
} // namespace sabot
