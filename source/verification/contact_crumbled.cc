#include "sabot/couplings/particle_contact.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/verification/balance.h"
#include "sabot/verification/problem.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3, speed = 200.;

std::unique_ptr<SpgBody> block(const std::string &name, const int id,
                               const std::array<double, 3> &size,
                               const std::array<double, 3> &centre,
                               const double velocity, const bool crumbles)
{
  SpgOptions options;
  options.initial_velocity = {{0., 0., velocity}};
  if (crumbles)
    options.critical_effective_plastic_strain = 0.1;
  const auto metal = std::make_shared<HardeningPlasticity>(
      ElasticConstants{2700., 68.9e9, 0.33},
      HardeningParameters{324e6, 150e6, 1.});
  return std::make_unique<SpgBody>(
      name, id, make_box_cloud(centre, size, spacing), metal, options);
}

/** Break what can break: strained, and shaken so that bonds are stretched. */
void crumble(SpgBody &body, const int seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-60., 60.);
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    body.set_state("effective plastic strain", i, 1.);
    n.velocity[i] +=
        vec(uniform(generator), uniform(generator), uniform(generator));
  }
}

struct Encounter
{
  double broken = 0.;   // part of the bonds of the upper body
  double momentum = 0.; // change over the first
  double given = 0.;    // by contact, largest, over the energy
  double gain = 0.;     // of energy, largest, over the first
  double deep = 0.;     // nodes deep inside, most at a time
  double through = 0.;  // of the upper body, nodes past the middle of the lower
  double parting = 0.;  // relative velocity after over before
};

/** A block falls on another, wider one; @p both: the lower crumbles too. */
Encounter meet(const bool both)
{
  World world;
  world.bodies.push_back(block("upper", 0, {{4e-3, 4e-3, 4e-3}},
                               {{0.2e-3, 0.3e-3, 2.5e-3}}, -speed, true));
  world.bodies.push_back(
      block("lower", 1, {{12e-3, 12e-3, 4e-3}}, {{0., 0., -2e-3}}, 0., both));
  world.couplings.push_back(std::make_unique<ParticleContact>(
      "contact", world.pointers(), std::vector<std::pair<int, int>>{{0, 1}},
      ContactOptions(), MPI_COMM_WORLD));
  const std::vector<std::pair<int, int>> debris = {{0, 0}, {0, 1}, {1, 1}};
  world.couplings.push_back(
      std::make_unique<SelfContact>("debris", world.pointers(), debris,
                                    SelfContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  auto &upper = static_cast<SpgBody &>(*world.bodies[0]),
       &lower = static_cast<SpgBody &>(*world.bodies[1]);
  crumble(upper, 1);
  if (both)
    crumble(lower, 2);
  world.integrator.initialize();
  const double energy = balance(world);
  const auto before = world.momenta();
  Encounter result;
  while (world.integrator.time < 40e-6)
  {
    world.advance(0.5);
    result.given = std::max(result.given, -world.energies()[2] / energy);
    result.gain = std::max(result.gain, balance(world) / energy - 1.);
    for (const Measure &m : world.couplings[0]->measure())
      if (m.name == "nodes deep inside")
        result.deep = std::max(result.deep, m.value);
  }
  const auto after = world.momenta();
  for (int d = 0; d < 3; ++d)
    result.momentum =
        std::max(result.momentum, std::abs((after[d] - before[d]) / before[2]));
  result.broken = measure(upper, "bonds broken fraction");
  // The middle of the lower body, where it is now.
  double middle = 0., mass = 0.;
  const NodalState &l = lower.nodes(), &u = upper.nodes();
  for (std::size_t i = 0; i < l.n_owned; ++i)
  {
    middle += l.lumped_mass[i] * l.position[i][2];
    mass += l.lumped_mass[i];
  }
  for (std::size_t i = 0; i < u.n_owned; ++i)
    result.through += u.position[i][2] < middle / mass;
  result.parting =
      (measure(upper, "velocity z") - measure(lower, "velocity z")) / speed;
  return result;
}

std::vector<Check> crumbled()
{
  std::vector<Check> checks;
  for (const bool both : {false, true})
  {
    const Encounter e = meet(both);
    const std::string what =
        both ? "crumbled on crumbled: " : "crumbled on sound: ";
    checks.push_back({what + "broken bonds of the upper block", 0.5, e.broken,
                      0., "1", "it is debris", Check::Kind::at_least});
    checks.push_back({what + "momentum, change over the first", 0., e.momentum,
                      1e-12, "1", "equal and opposite forces"});
    checks.push_back({what + "particles past the middle of the lower block", 0.,
                      e.through, 0., "1", "none leaks"});
    checks.push_back({what + "nodes deep inside", 0., e.deep, 0., "1",
                      "held at the surface"});
    checks.push_back({what + "relative velocity after over before", 0.,
                      e.parting, 0., "1", "they part", Check::Kind::at_least});
    checks.push_back({what + "energy given by contact, largest", 0., e.given,
                      1e-2, "1", "no energy from nowhere",
                      Check::Kind::at_most});
    checks.push_back({what + "largest gain of energy", 0., e.gain, 1e-2, "1",
                      "energy balance", Check::Kind::at_most});
  }
  return checks;
}

const RegisterProblem
    a({"contact-particle-crumbled",
       "a block that has crumbled falls on a sound and on a crumbled one",
       "quick", crumbled});
} // namespace
} // namespace sabot
