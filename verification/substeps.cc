// Bodies that make several steps within one of the scene: the impact of
// St-Venant on a mesh that is finer, and a fine block that rests on a coarse
// one, where impulses might feed the block's own modes.
#include "sabot/couplings/contact.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <cstdio>

namespace sabot
{
namespace
{
void add_box(World &world, const std::array<double, 3> &size,
             const std::array<double, 3> &center, const double h,
             FemOptions options, const double nu)
{
  BoxSpecification box;
  box.size = size;
  box.center = center;
  box.cell_size = h;
  const int id = world.bodies.size();
  world.bodies.push_back(std::make_unique<FemBody>("body" + std::to_string(id),
                                                   id, make_graded_box(box),
                                                   elastic(nu), options));
}

void start(World &world, const ContactOptions &contact)
{
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, contact,
      MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

/** Follows the balance as a run does: without the energy of the last half kick,
    over the largest kinetic and internal energy so far. */
class Watch
{
public:
  explicit Watch(World &world) : world(world) { look(); }
  void look()
  {
    const EnergyLedger ledger = world.ledger();
    double total = ledger.total().value();
    if (world.stepper.last_step() > 0.)
    {
      ExactSum kick;
      for (const auto &body : world.bodies)
        body->add_kick_energy(world.stepper.last_step(), kick);
      total -= kick.value();
    }
    largest = std::max(
        {largest, ledger.kinetic.value(), std::abs(world.internal_energy())});
    if (n++ == (starts_at_rest() ? 1 : 0))
      first = total;
    residual = std::max(residual, std::abs(total - first));
  }
  /** Of a load that is there at once the first half kick counts, too. */
  bool starts_at_rest() const { return !world.loads.empty(); }
  double residual_share() const { return residual / largest; }

private:
  World &world;
  double first = 0., largest = 0., residual = 0.;
  int n = 0;
};

std::string of_ratio(const double ratio, const unsigned int most)
{
  char text[80];
  std::snprintf(text, sizeof(text),
                "cells %g times finer, up to %u steps: ", ratio, most);
  return text;
}

/** A bar strikes an equal one of a finer mesh; nu = 0 so that one dimension is
    exact. */
void strike(const double ratio, const unsigned int most,
            std::vector<Check> &checks)
{
  const double c = std::sqrt(aluminum().young_modulus / aluminum().density);
  const double length = 20e-3, w = 1e-3, v = 10., h = 0.5e-3;
  World world(most);
  FemOptions striker;
  striker.initial_velocity = {{v, 0., 0.}};
  add_box(world, {{length, w, w}}, {{-0.5 * length, 0., 0.}}, h, striker, 0.);
  add_box(world, {{length, w, w}}, {{0.5 * length, 0., 0.}}, h / ratio,
          FemOptions(), 0.);
  start(world, ContactOptions());
  Watch watch(world);
  const double momentum = world.momenta()[0];
  while (world.stepper.time() < 3. * length / c)
  {
    world.advance(0.9);
    watch.look();
  }
  // More than two make a softer blow: not the standard, and told, not judged.
  const auto kind = most > 2 ? Check::Kind::reported : Check::Kind::near;
  const std::string what = of_ratio(ratio, most);
  checks.push_back({what + "velocity of the struck bar", v,
                    world.bodies[1]->measure().velocity[0], 0.01 * v, "m/s",
                    "equal bars exchange velocities", kind});
  checks.push_back({what + "momentum after over before, less one", 0.,
                    world.momenta()[0] / momentum - 1., 1e-12, "1",
                    "impulses are equal and opposite"});
  checks.push_back({what + "energy residual", 0., watch.residual_share(), 1e-3,
                    "1", "energy balance", Check::Kind::at_most});
  const double expected = std::min<double>(most, ratio);
  checks.push_back({what + "steps of the fine bar within one", expected,
                    world.stepper.mean_substeps(*world.bodies[1]),
                    0.35 * expected, "1", "ratio of the stable steps"});
}

/** A fine block on a clamped coarse one under a weight that presses it, over
    many periods of what the contact's impulses might feed: with the standard
    damping, or with none. */
void press(const double ratio, const double factor, const bool is_damped,
           std::vector<Check> &checks)
{
  const double h = 1e-3;
  World world(16);
  FemOptions block;
  block.hourglass = "stiffness";
  ContactOptions contact;
  if (!is_damped)
    contact.damping_fraction = block.bulk_viscosity_linear =
        block.bulk_viscosity_quadratic = 0.;
  FemOptions ground = block;
  ground.clamped_boundary_ids = {4};
  add_box(world, {{2e-3, 2e-3, 1e-3}}, {{0., 0., 0.5e-3}}, h / ratio, block,
          0.3);
  add_box(world, {{4e-3, 4e-3, 2e-3}}, {{0., 0., -1e-3}}, h, ground, 0.3);
  world.add_load("gravity",
                 {{"Acceleration", "0, 0, -1e4 km/s^2"}, {"Bodies", "body0"}});
  start(world, contact);
  Watch watch(world);
  double fastest = 0., early = 0.;
  constexpr int n = 1500;
  for (int s = 0; s < n; ++s)
  {
    world.advance(factor);
    if (s % 10 != 0)
      continue;
    watch.look();
    fastest = std::max(fastest, world.ledger().kinetic.value());
    if (s < n / 10)
      early = fastest;
  }
  char text[80];
  std::snprintf(text, sizeof(text),
                "cells %g times finer, factor %g%s: ", ratio, factor,
                is_damped ? "" : ", undamped");
  const std::string what = text;
  // Without any damping the fourth part of a step may feed a mode, slowly.
  const auto kind = is_damped ? Check::Kind::at_most : Check::Kind::reported;
  checks.push_back({what + "energy residual", 0., watch.residual_share(), 1e-3,
                    "1", "energy balance", kind});
  checks.push_back({what + "most kinetic energy over that of the first tenth",
                    1., fastest / early, 0.1, "1", "nothing is fed", kind});
}

std::vector<Check> substeps()
{
  std::vector<Check> checks;
  for (const double ratio : {2., 4.})
    for (const unsigned int most : {1u, 2u, 4u})
      strike(ratio, most, checks);
  for (const double ratio : {2., 3., 4.})
    for (const double factor : {0.45, 0.7, 0.9})
      press(ratio, factor, true, checks);
  press(2., 0.7, false, checks);
  press(4., 0.7, false, checks);
  return checks;
}

const RegisterProblem registered({"substeps",
                                  "fine bodies make several steps within one",
                                  "quick", substeps});
} // namespace
} // namespace sabot
