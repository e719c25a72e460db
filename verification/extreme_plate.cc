// The perforated plate, coarse, from 1 m/s to 6 km/s.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/tie.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
struct Outcome
{
  std::string problem; // empty after a clean end
  double residual, speed, broken;
  unsigned int steps;
};

/** The plate of the perforation problem, cut down: 60 x 60 x 12.5 mm with 30 x
    30 mm of particles 2.5 mm apart, the projectile of 13.6 g at @p speed, and
    Mie-Gruneisen pressure, for @p end. */
Outcome strike(const double speed, const double end)
{
  constexpr double h = 2.5e-3, thickness = 12.5e-3;
  const auto target = metal("al6061-t6-eos");
  const auto striker = std::make_shared<HardeningPlasticity>(
      aluminum(), HardeningParameters{aluminum_yield_stress(), 150e6, 0.},
      std::make_shared<MieGruneisen>(
          mie_gruneisen_parameters("al6061-t6-eos")));
  World world;
  BoxSpecification box;
  box.size = {{60e-3, 60e-3, thickness}};
  box.center = {{0., 0., -0.5 * thickness}};
  box.cell_size = h;
  box.coarsest_cell_size = 2. * h;
  box.growth_ratio = 1.3;
  box.has_zone = true;
  box.zone_center = box.center;
  box.zone_size = {{30e-3, 30e-3, thickness}};
  FemOptions plate;
  plate.clamped_boundary_ids = {0, 1};
  plate.inversion = FemOptions::Inversion::erode;
  world.bodies.push_back(std::make_unique<FemBody>(
      "plate", 0, make_graded_box(box), target, plate));
  SpgOptions core;
  core.set_critical_plastic_strain(0.4);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "core", 1, make_box_cloud(box.center, box.zone_size, h), target, core));
  FemOptions projectile;
  projectile.initial_velocity = {{0., 0., -speed}};
  projectile.inversion = FemOptions::Inversion::erode;
  world.bodies.push_back(std::make_unique<FemBody>(
      "projectile", 2,
      make_cylinder(8.35e-3, 23e-3, 2, {{0., 0., 11.51e-3}}, 2.8e-3), striker,
      projectile));
  ContactOptions contact;
  contact.friction = coulomb(0.3);
  world.couplings.push_back(std::make_unique<Contact>(
      "impact", world.pointers(),
      std::vector<ContactPair>{{0, 1, true}, {0, 2}, {2, 0}, {2, 1}}, contact,
      MPI_COMM_WORLD));
  SelfContactOptions debris;
  debris.friction = coulomb(0.3);
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{1, 1}},
      debris, MPI_COMM_WORLD));
  world.couplings.push_back(std::make_unique<Tie>("zone", world.pointers(), 1,
                                                  0, 0.05, MPI_COMM_WORLD));
  world.distribute();
  Outcome outcome{};
  try
  {
    world.stepper.initialize();
    EnergyWatch watch(world);
    while (world.stepper.time() < end && world.stepper.steps() < 20000)
    {
      // Cells that a step moves by a part of their size want shorter ones.
      world.advance(speed > 2000. ? 0.5 : 0.9);
      if (world.stepper.steps() % 5 == 0)
        watch.look();
    }
    watch.look();
    outcome.residual = watch.residual();
    if (!is_finite(world))
      outcome.problem = "not a number";
    else if (world.stepper.time() < end)
      outcome.problem = "the step collapsed";
  }
  catch (const PhysicsError &e)
  {
    outcome.problem = e.what();
  }
  outcome.steps = world.stepper.steps();
  outcome.speed = -world.bodies[2]->measure().velocity[2];
  outcome.broken = world.bodies[1]->measure().bonds_broken_fraction;
  return outcome;
}

std::vector<Check> plate()
{
  std::vector<Check> checks;
  for (const double speed : {1., 10., 100., 970., 3000., 6000.})
  {
    // The projectile has crossed the plate where it does, and has rebounded
    // where it does not: its waves have run up and down twice.
    const Outcome o = strike(speed, speed < 2000. ? 40e-6 : 20e-6);
    const std::string at = std::to_string(int(speed)) + " m/s: ";
    checks.push_back(
        {at + "clean end" + (o.problem.empty() ? "" : " (" + o.problem + ")"),
         1., double(o.problem.empty()), 0., "1", "no stop"});
    checks.push_back({at + "energy residual", 0.01, o.residual, 0., "1",
                      "energy balance", Check::Kind::at_most});
    checks.push_back({at + "speed of the projectile over the first", 0.,
                      o.speed / speed, 0., "1", "", Check::Kind::reported});
    checks.push_back({at + "broken bonds", 0., o.broken, 0., "1", "",
                      Check::Kind::reported});
    checks.push_back({at + "steps", 0., double(o.steps), 0., "1", "",
                      Check::Kind::reported});
  }
  return checks;
}

const RegisterProblem registered({"extreme-plate",
                                  "the plate at 1 m/s to 6 km/s, coarse",
                                  "extremes", plate});
} // namespace
} // namespace sabot
