// Blocks of particles that have lost their bonds and fall on each other.
#include "sabot/base/choice.h"
#include "sabot/couplings/particle_contact.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/kernels/kernel_function.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3, speed = 200.;

std::unique_ptr<SpgBody> block(const std::string &name, const int id,
                               const std::array<double, 3> &size,
                               const std::array<double, 3> &center,
                               const double velocity, const bool crumbles,
                               const std::string &rule)
{
  SpgOptions options;
  options.initial_velocity = {{0., 0., velocity}};
  options.residual_strength = choose<ResidualStrength>(rule);
  if (crumbles)
    options.set_critical_plastic_strain(0.1);
  const auto metal = hardening_aluminum();
  return std::make_unique<SpgBody>(
      name, id, make_box_cloud(center, size, spacing), metal, options);
}

/** Break what can break: strained, and shaken so that bonds are stretched. */
void crumble(SpgBody &body, const int seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-60., 60.);
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    body.rooms().points.state("effective plastic strain")[i] = 1.;
    n.velocity[i] +=
        vec(uniform(generator), uniform(generator), uniform(generator));
  }
}

struct Encounter
{
  double broken = 0.;   // part of the bonds of the upper body
  double momentum = 0.; // change over the first
  double given = 0.;    // by contact, largest, over the energy
  double gain = 0.;     // of energy, largest, over that before they touch
  double deep = 0.;     // nodes deep inside, most at a time
  double shared = 0.;   // see shared_part(), largest
  double parting = 0.;  // relative velocity after over before
};

/** Part of a body's space that the other one fills as well: the mean of the
    other's filled part at its particles. */
double shared_part(const SpgBody &body, const SpgBody &other)
{
  const NodalState &mine = body.nodes(), &its = other.nodes();
  std::vector<VolumePoint> volume;
  for (std::size_t j = 0; j < its.n_owned; ++j)
    volume.push_back(other.particles()->volume_point(j));
  double sum = 0.;
  for (std::size_t i = 0; i < mine.n_owned; ++i)
    for (std::size_t j = 0; j < its.n_owned; ++j)
    {
      const Vec d = mine.position[i] - its.position[j];
      if (norm_square(d) < 16. * spacing * spacing)
        sum += volume[j].content * cubic_spline(norm(volume[j].to_unit * d));
    }
  return sum / mine.n_owned;
}

/** A block falls on another, wider one; @p both: the lower crumbles too. */
Encounter meet(const bool both, const bool with_contact,
               const std::string &rule)
{
  World world;
  world.bodies.push_back(block("upper", 0, {{4e-3, 4e-3, 4e-3}},
                               {{0.2e-3, 0.3e-3, 2.5e-3}}, -speed, true, rule));
  world.bodies.push_back(block("lower", 1, {{12e-3, 12e-3, 4e-3}},
                               {{0., 0., -2e-3}}, 0., both, rule));
  world.couplings.push_back(std::make_unique<ParticleContact>(
      "contact", world.pointers(),
      with_contact ? std::vector<std::pair<int, int>>{{0, 1}}
                   : std::vector<std::pair<int, int>>{},
      ContactOptions(), MPI_COMM_WORLD));
  std::vector<std::pair<int, int>> debris = {{0, 0}, {1, 1}};
  if (with_contact)
    debris.insert(debris.begin() + 1, {0, 1});
  world.couplings.push_back(
      std::make_unique<SelfContact>("debris", world.pointers(), debris,
                                    SelfContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  auto &upper = static_cast<SpgBody &>(*world.bodies[0]),
       &lower = static_cast<SpgBody &>(*world.bodies[1]);
  crumble(upper, 1);
  if (both)
    crumble(lower, 2);
  world.stepper.initialize();
  double energy = 0.;
  const auto before = world.momenta();
  Encounter result;
  while (world.stepper.time() < 40e-6)
  {
    world.advance(0.5);
    // They crumble by themselves first and touch after 2.3 us.
    if (world.stepper.time() < 2e-6)
      continue;
    if (energy == 0.)
      energy = world.total_energy();
    result.given = std::max(result.given, -world.contact_energy() / energy);
    result.gain = std::max(result.gain, world.total_energy() / energy - 1.);
    if (world.stepper.steps() % 20 == 0)
      result.shared = std::max(result.shared, shared_part(upper, lower));
    for (const Measure &m : world.couplings[0]->measure())
      if (m.name == "nodes deep inside")
        result.deep = std::max(result.deep, m.value);
  }
  const auto after = world.momenta();
  for (int d = 0; d < 3; ++d)
    result.momentum =
        std::max(result.momentum, std::abs((after[d] - before[d]) / before[2]));
  result.broken = upper.measure().bonds_broken_fraction;
  result.parting =
      (upper.measure().velocity[2] - lower.measure().velocity[2]) / speed;
  return result;
}

std::vector<Check> crumbled()
{
  std::vector<Check> checks;
  // Loose particles, and crumbled metal that stays a continuum.
  for (const std::string rule : {"compression", "friction"})
    for (const bool both : {false, true})
    {
      const Encounter e = meet(both, true, rule),
                      unhindered = meet(both, false, rule);
      const bool is_loose = rule == "compression";
      const std::string what =
          rule + (both ? ", crumbled on crumbled: " : ", crumbled on sound: ");
      checks.push_back({what + "broken bonds of the upper block", 0.5, e.broken,
                        0., "1", "it is debris", Check::Kind::at_least});
      checks.push_back({what + "momentum, change over the first", 0.,
                        e.momentum, 1e-12, "1", "equal and opposite forces"});
      checks.push_back({what + "part of its space that the other fills too",
                        is_loose ? 0.15 : 0.25, e.shared, 0., "1",
                        "a face of its layers at most", Check::Kind::at_most});
      checks.push_back(
          {what + "the same without contact", 0.3, unhindered.shared, 0., "1",
           "the measure sees what passes through", Check::Kind::at_least});
      checks.push_back({what + "nodes deep inside", 0., e.deep, 0., "1",
                        "held at the surface"});
      // Heaps stop in each other's way; a heap and a block part.
      checks.push_back({what + "relative velocity after over before",
                        both ? (is_loose ? -0.2 : -0.25) : 0., e.parting, 0.,
                        "1", both ? "they stop" : "they part",
                        Check::Kind::at_least});
      checks.push_back({what + "the same without contact", 0.,
                        unhindered.parting, 0., "1", "",
                        Check::Kind::reported});
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
