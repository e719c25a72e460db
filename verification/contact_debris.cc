// Two pieces of a broken bar collide through self-contact.
#include "sabot/base/choice.h"
#include "sabot/couplings/self_contact.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3, approach = 20.;

struct Collision
{
  double n_pieces = 0.;
  double momentum = 0.;      // change over that of the approach
  double gain = 0.;          // of energy, largest, over all energy
  double given = 0.;         // by contact, largest, over the kinetic
  double gap = 1e9;          // least, over the spacing
  double right_velocity = 0; // of the right piece after, over the approach
  double kinetic = 0.;       // after over before
};

/** Two blocks of one body, apart by broken bonds, meet with +-v: only
    self-contact holds them off. */
Collision collide(const double stiffness_scale)
{
  World world;
  SpgOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  options.set_critical_plastic_strain(0.1);
  // Loose particles are what self-contact alone holds apart.
  options.residual_strength = choose<ResidualStrength>("compression");
  const auto metal = hardening_aluminum();
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0, make_box_cloud({{0, 0, 0}}, {{11e-3, 3e-3, 3e-3}}, spacing),
      metal, options));
  SelfContactOptions contact;
  contact.stiffness_scale = stiffness_scale;
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      contact, MPI_COMM_WORLD));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  // Break the middle: strained particles whose bonds are stretched.
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double x = n.reference_position[i][0];
    if (std::abs(x) < 1.6e-3)
      body.rooms().points.state("effective plastic strain")[i] = 1.;
    n.velocity[i] = vec(x > 0. ? 60. : -60., 0., 0.);
  }
  world.stepper.initialize();
  while (body.fragments()->connected_pieces().size() < 2 &&
         world.stepper.time() < 20e-6)
    world.advance(0.5);
  Collision result;
  result.n_pieces = body.fragments()->connected_pieces().size();
  // The break is over when nothing fails any more.
  const double broken = world.stepper.time();
  while (world.stepper.time() < 2. * broken)
    world.advance(0.5);
  // Let them meet.
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] =
        vec(n.reference_position[i][0] > 0. ? -approach : approach, 0., 0.);
  const auto before = world.momenta();
  const double energy = world.total_energy(), mass = body.measure().mass,
               kinetic = world.ledger().kinetic.value(),
               taken = world.contact_energy();
  double highest = energy;
  const double end = world.stepper.time() + 100e-6;
  while (world.stepper.time() < end)
  {
    world.advance(0.25);
    highest = std::max(highest, world.total_energy());
    result.given =
        std::max(result.given, (taken - world.contact_energy()) / kinetic);
    double left = -1e9, right = 1e9;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (n.reference_position[i][0] < 0.)
        left = std::max(left, n.position[i][0]);
      else
        right = std::min(right, n.position[i][0]);
    result.gap = std::min(result.gap, (right - left) / spacing);
  }
  double right_mass = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (n.reference_position[i][0] > 0.)
    {
      result.right_velocity += n.lumped_mass[i] * n.velocity[i][0] / approach;
      right_mass += n.lumped_mass[i];
    }
  result.right_velocity /= right_mass;
  result.momentum = (world.momenta()[0] - before[0]) / (mass * approach);
  result.gain = (highest - energy) / energy;
  result.kinetic = world.ledger().kinetic.value() / kinetic;
  return result;
}

std::vector<Check> fragments()
{
  // The stiffness is K h times the scale; a factor of four must not matter.
  std::vector<Check> checks;
  std::vector<Collision> all;
  for (const double scale : {0.5, 1., 2.})
  {
    const Collision c = collide(scale);
    all.push_back(c);
    char text[40];
    std::snprintf(text, sizeof(text), "stiffness %.1f K h: ", scale);
    const std::string what = text;
    checks.push_back({what + "pieces after the break", 2., c.n_pieces, 0., "1",
                      "connected components", Check::Kind::at_least});
    checks.push_back({what + "momentum change over m v", 0., c.momentum, 1e-12,
                      "1", "equal and opposite forces"});
    checks.push_back({what + "energy given by contact over the kinetic", 0.,
                      c.given, 1e-3, "1", "it only takes",
                      Check::Kind::at_most});
    // The rest is the particles' ledger; stiffer contact shakes them more.
    checks.push_back(
        {what + "largest gain of energy", 0., c.gain, 1e-3, "1",
         "energy balance",
         scale == 1. ? Check::Kind::at_most : Check::Kind::reported});
    checks.push_back({what + "least gap over spacing", 0., c.gap, 0., "1",
                      "pieces do not pass through each other",
                      Check::Kind::at_least});
    checks.push_back({what + "velocity of the right piece over the approach",
                      0., c.right_velocity, 0.3, "1",
                      "the pieces have stopped each other"});
  }
  double gaps[2] = {1e9, -1e9}, speeds[2] = {1e9, -1e9};
  for (const Collision &c : all)
  {
    gaps[0] = std::min(gaps[0], c.gap);
    gaps[1] = std::max(gaps[1], c.gap);
    speeds[0] = std::min(speeds[0], c.right_velocity);
    speeds[1] = std::max(speeds[1], c.right_velocity);
  }
  checks.push_back({"factor 4 in stiffness: change of the least gap over "
                    "spacing",
                    0., gaps[1] - gaps[0], 0.1, "1", "no free constant"});
  checks.push_back({"factor 4 in stiffness: change of the velocity over the "
                    "approach",
                    0., speeds[1] - speeds[0], 0.1, "1", "no free constant"});
  return checks;
}

const RegisterProblem a({"spg-fragments",
                         "two pieces collide through self-contact, by its "
                         "stiffness",
                         "quick", fragments});
} // namespace
} // namespace sabot
