// Contact of particles with particles: friction, smoothness, stability.
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/particle_contact.h"
#include "sabot/materials/laws.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** Particles with a weight of their own, along -z. */
class HeavyParticles : public SpgBody
{
public:
  HeavyParticles(const ParticleCloud &cloud, const SpgOptions &options,
                 const double weight)
      : SpgBody("block", 0, cloud, elastic(), options), weight(weight)
  {
  }
  void compute_forces(const double time, const double dt) override
  {
    SpgBody::compute_forces(time, dt);
    NodalState &n = nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.force[i] += vec(0., 0., -weight * n.lumped_mass[i]);
  }

private:
  const double weight; // [m/s^2]
};

void add_contact(World &world, const ContactOptions &options)
{
  world.couplings.push_back(std::make_unique<ParticleContact>(
      "contact", world.pointers(), std::vector<std::pair<int, int>>{{0, 1}},
      options, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

/** A heavy block slides over a slab that is held at its lower face and its
    ends, over more than a spacing. */
std::vector<Check> sliding()
{
  const double g = 1e7, v = 100., mu = 0.3;
  World world;
  SpgOptions block, slab;
  block.initial_velocity = {{v, 0., 0.}};
  slab.symmetry_faces = 0b011111; // but for +z
  world.bodies.push_back(std::make_unique<HeavyParticles>(
      make_box_cloud({{0.4e-3, 0.3e-3, 1e-3}}, {{4e-3, 4e-3, 2e-3}}, 1e-3),
      block, g));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "slab", 1,
      make_box_cloud({{1e-3, 0., -1e-3}}, {{10e-3, 8e-3, 2e-3}}, 1e-3),
      elastic(), slab));
  ContactOptions options;
  options.friction = coulomb(mu);
  add_contact(world, options);
  double x = 0., stopped_at = std::nan(""), distance = stopped_at, worst = 0.,
         before = v;
  while (world.stepper.time() < 40e-6)
  {
    const double dt = world.advance(0.5);
    const double now = world.bodies[0]->measure().velocity[0];
    x += dt * now;
    const double impulse =
        g * world.stepper.time() + world.bodies[0]->measure().velocity[2];
    if (std::isnan(stopped_at) && now <= 0.02 * v)
    {
      stopped_at =
          world.stepper.time() - dt * (0.02 * v - now) / (before - now);
      distance = x;
    }
    before = now;
    if (now > 0.1 * v && impulse > 0.1 * v)
      worst = std::max(worst, std::abs((v - now) / impulse - mu));
  }
  return {{"time to a fiftieth of the speed", 0.98 * v / (mu * g), stopped_at,
           0.02 * v / (mu * g), "s", "0.98 v/(mu g)"},
          {"stopping distance", v * v / (2. * mu * g), distance,
           0.02 * v * v / (2. * mu * g), "m", "v^2/(2 mu g), 1.7 spacings"},
          {"loss of speed over impulse of the normal force, worst error", 0.,
           worst, 0.02 * mu, "1", "Coulomb: no bumps"}};
}

/** The shear strength of worked metal is that of its state: the same motion as
    with this strength given, and another than with that of the start. */
std::vector<Check> worked_metal()
{
  const double g = 5e5, v = 10., tau = 1e6, Y = std::sqrt(3.) * tau;
  HardeningParameters hardening;
  hardening.table_strain = {0., 1., 2.};
  hardening.table_stress = {0.25 * Y, 0.25 * Y, Y};
  const auto metal =
      std::make_shared<HardeningPlasticity>(aluminum(), hardening);
  const auto loss = [&](const ContactOptions &options, const double strain)
  {
    World world;
    SpgOptions block, slab;
    block.initial_velocity = {{v, 0., 0.}};
    slab.symmetry_faces = 0b011111;
    world.bodies.push_back(std::make_unique<HeavyParticles>(
        make_box_cloud({{0.4e-3, 0.3e-3, 1e-3}}, {{4e-3, 4e-3, 2e-3}}, 1e-3),
        block, g));
    world.bodies.push_back(std::make_unique<SpgBody>(
        "slab", 1,
        make_box_cloud({{1e-3, 0., -1e-3}}, {{10e-3, 8e-3, 2e-3}}, 1e-3), metal,
        slab));
    add_contact(world, options);
    auto &body = static_cast<SpgBody &>(*world.bodies[1]);
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      body.rooms().points.state("effective plastic strain")[i] = strain;
    world.couplings[0]->update_search(0, 1.); // looks anew
    while (world.stepper.time() < 2e-6)
      world.advance(0.5);
    return v - world.bodies[0]->measure().velocity[0];
  };
  ContactOptions by_yield, given, given_soft;
  by_yield.friction = given.friction = given_soft.friction = coulomb(8.);
  by_yield.shear_strength = ShearStrength::of_yield();
  given.shear_strength = ShearStrength::given(tau);
  given_soft.shear_strength = ShearStrength::given(0.25 * tau);
  const double hard = loss(given, 3.), soft = loss(given_soft, 0.);
  return {{"loss of speed on hardened metal", hard, loss(by_yield, 3.),
           1e-5 * hard, "m/s", "as with the strength Y(eps)/sqrt(3) given"},
          {"loss of speed on metal as it was", soft, loss(by_yield, 0.),
           1e-5 * soft, "m/s", "as with the strength Y(0)/sqrt(3) given"},
          {"the one over the other", 4., hard / soft, 0.2, "1",
           "the strengths' ratio"}};
}

/** Without friction a pressed block keeps its speed on a lattice. */
std::vector<Check> frictionless()
{
  const double g = 1e7, v = 100.;
  World world;
  SpgOptions block, slab;
  block.initial_velocity = {{v, 0., 0.}};
  slab.symmetry_faces = 0b011111;
  world.bodies.push_back(std::make_unique<HeavyParticles>(
      make_box_cloud({{-2e-3, 0.3e-3, 1e-3}}, {{4e-3, 4e-3, 2e-3}}, 1e-3),
      block, g));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "slab", 1,
      make_box_cloud({{1e-3, 0., -1e-3}}, {{10e-3, 8e-3, 2e-3}}, 1e-3),
      elastic(), slab));
  add_contact(world, ContactOptions());
  double slowest = v, fastest = v;
  while (world.stepper.time() < 30e-6)
  {
    world.advance(0.5);
    const double now = world.bodies[0]->measure().velocity[0];
    slowest = std::min(slowest, now);
    fastest = std::max(fastest, now);
  }
  return {{"loss of speed over three spacings, over the normal impulse", 0.,
           (v - slowest) / (g * 30e-6), 0.01, "1", "planes are smooth"},
          {"gain of speed over the normal impulse", 0.,
           (fastest - v) / (g * 30e-6), 0.01, "1", "planes are smooth"}};
}

/** Slabs of different spacing thrown onto each other with the stiffest penalty
    and shaken: many springs on one particle stay within the stable step. */
std::vector<Check> stability()
{
  std::vector<Check> checks;
  for (const double fine : {1e-3, 0.5e-3, 0.3e-3})
  {
    World world;
    SpgOptions upper, lower;
    upper.initial_velocity = {{3., 0., -20.}};
    world.bodies.push_back(std::make_unique<SpgBody>(
        "upper", 0,
        make_box_cloud({{0.1e-3, 0.2e-3, 1e-3}}, {{3e-3, 3e-3, 2e-3}}, fine),
        elastic(), upper));
    world.bodies.push_back(std::make_unique<SpgBody>(
        "lower", 1,
        make_box_cloud({{0., 0., -1e-3}}, {{5e-3, 5e-3, 2e-3}}, 1e-3),
        elastic(), lower));
    ContactOptions options;
    options.damping_fraction = 0.;
    options.stiffness_scale = 10.;
    add_contact(world, options);
    const double energy = world.total_energy();
    double gain = 0., deepest = 0.;
    while (world.stepper.time() < 12e-6)
    {
      world.advance(0.9);
      gain = std::max(gain, world.total_energy() / energy - 1.);
    }
    for (const Measure &m : world.couplings[0]->measure())
      if (m.name == "penetration max over spacing")
        deepest = m.value;
    char where[40];
    std::snprintf(where, sizeof(where), "%.1f on 1.0 mm: ", fine * 1e3);
    checks.push_back({std::string(where) + "highest energy", 0., gain, 0., "1",
                      "steps of 0.9", Check::Kind::reported});
    checks.push_back({std::string(where) + "gain of energy after parting", 0.,
                      world.total_energy() / energy - 1., 2e-3, "1",
                      "energy balance", Check::Kind::at_most});
    checks.push_back({std::string(where) + "penetration over spacing", 0.2,
                      deepest, 0., "1", "held", Check::Kind::at_most});
    checks.push_back({std::string(where) + "they part: relative velocity z", 0.,
                      world.bodies[0]->measure().velocity[2] -
                          world.bodies[1]->measure().velocity[2],
                      0., "m/s", "rebound", Check::Kind::at_least});
  }
  return checks;
}

const RegisterProblem
    a({"contact-particle-sliding",
       "friction of a heavy block of particles on a slab of particles", "quick",
       sliding}),
    b({"contact-particle-smooth",
       "a lattice slides on a lattice without friction", "quick",
       frictionless}),
    c({"contact-particle-stability",
       "the stiffest penalty, fine and coarse particles", "quick", stability}),
    d({"contact-particle-worked-metal",
       "shear strength of friction on hardened particles", "quick",
       worked_metal});
} // namespace
} // namespace sabot
