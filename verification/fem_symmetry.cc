// Planes of symmetry: quarters of models against the whole, and driven ends.
#include "sabot/couplings/contact.h"
#include "verification/halves.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** A copper bar on a wall that it sticks to: its end face is a plane of
    symmetry. */
void taylor_bar(World &world, const unsigned int n_cuts)
{
  FemOptions options;
  options.initial_velocity = {{0., 0., -227.}};
  options.symmetry_boundary_ids = {0};
  for (unsigned int cut = 0; cut < n_cuts; ++cut)
    options.symmetry_boundary_ids.push_back(3 + cut);
  world.bodies.push_back(std::make_unique<FemBody>(
      "bar", 0, make_cylinder(3.2e-3, 12e-3, 2, {{0, 0, 6e-3}}, 1e-3, n_cuts),
      taylor_copper(), options));
  world.distribute();
  world.stepper.initialize();
}

std::vector<Check> quarter_taylor()
{
  World whole, quarter;
  taylor_bar(whole, 0);
  taylor_bar(quarter, 2);
  double step_difference = 0.;
  while (whole.stepper.time() < 15e-6)
  {
    const double a = whole.stepper.propose(false).dt,
                 b = quarter.stepper.propose(false).dt;
    step_difference = std::max(step_difference, std::abs(b / a - 1.));
    whole.stepper.advance(0.9 * a);
    quarter.stepper.advance(0.9 * a);
  }
  const NodalState &n = quarter.bodies[0]->nodes();
  double across = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (int d = 0; d < 2; ++d)
      if (n.reference_position[i][d] == 0.)
        across = std::max(across, std::abs(n.position[i][d]));
  return {{"positions, largest difference over radius", 0.,
           largest_difference(*quarter.bodies[0], *whole.bodies[0]) / 3.2e-3,
           1e-10, "1", "symmetry of the problem"},
          {"stable step, largest relative difference", 0., step_difference,
           1e-10, "1", "symmetry"},
          {"four times the internal energy over the whole's", 1.,
           4. * quarter.internal_energy() / whole.internal_energy(), 1e-10, "1",
           "symmetry"},
          {"motion across the planes", 0., across, 1e-18, "m", "constraint"},
          {"largest plastic strain", 0.1,
           measure(*quarter.bodies[0], "plastic strain max"), 0., "1",
           "so that the comparison is plastic", Check::Kind::at_least}};
}

/** A block on a plate, whole or the quarter of both. */
void struck_plate(World &world, const bool quarter)
{
  const auto box =
      [&](const std::array<double, 3> &size, const double z, const double h)
  {
    BoxSpecification b;
    b.size = size;
    b.center = {{0., 0., z}};
    b.cell_size = h;
    if (quarter)
      for (int d = 0; d < 2; ++d)
      {
        b.size[d] *= 0.5;
        b.center[d] = 0.5 * b.size[d];
      }
    return make_graded_box(b);
  };
  FemOptions options;
  if (quarter)
    options.symmetry_boundary_ids = {0, 2};
  world.bodies.push_back(std::make_unique<FemBody>(
      "plate", 0, box({{12e-3, 12e-3, 2e-3}}, -1e-3, 1e-3), taylor_copper(),
      options));
  options.initial_velocity = {{0., 0., -50.}};
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 1, box({{4.8e-3, 4.8e-3, 3.6e-3}}, 1.81e-3, 1.2e-3),
      taylor_copper(), options));
  std::vector<ContactPair> pairs = {{0, 1}, {1, 0}};
  world.couplings.push_back(std::make_unique<Contact>(
      "impact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

std::vector<Check> quarter_contact()
{
  World whole, quarter;
  struck_plate(whole, false);
  struck_plate(quarter, true);
  const double before = quarter.total_energy();
  while (whole.stepper.time() < 4e-6)
  {
    const double dt = 0.7 * whole.stepper.propose(false).dt;
    whole.stepper.advance(dt);
    quarter.stepper.advance(dt);
  }
  const double exchanged = whole.bodies[0]->measure().velocity[2] / -50.;
  return {{"positions, largest difference over spacing", 0.,
           std::max(largest_difference(*quarter.bodies[0], *whole.bodies[0]),
                    largest_difference(*quarter.bodies[1], *whole.bodies[1])) /
               1e-3,
           1e-3, "1", "symmetry; the penalty sees the cut masses"},
          {"four times the quarter's energy over the whole's", 1.,
           4. * quarter.total_energy() / whole.total_energy(), 1e-3, "1",
           "symmetry"},
          {"energy kept by the quarter", 1., quarter.total_energy() / before,
           5e-3, "1", "conservation"},
          {"speed of the plate over the block's", 0.02, exchanged, 0., "1",
           "so that the bodies have met", Check::Kind::at_least}};
}

/** Nodal rows of an SPG box on two planes of symmetry stay in them. */
std::vector<Check> spg_planes()
{
  World world;
  SpgOptions options;
  options.symmetry_faces = 1 | 4; // -x, -y
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0,
      make_box_cloud({{2e-3, 2e-3, 2e-3}}, {{4e-3, 4e-3, 4e-3}}, 1e-3),
      elastic(), options));
  world.distribute();
  Body &body = *world.bodies[0];
  shake(body, 5.);
  world.stepper.initialize();
  const double before = world.total_energy();
  double across = 0., moved = 0.;
  // Short steps: the energy of noise oscillates by O((omega dt)^2).
  for (int step = 0; step < 200; ++step)
    world.advance(0.25);
  const NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (int d = 0; d < 3; ++d)
    {
      const double u = n.position[i][d] - n.reference_position[i][d];
      moved = std::max(moved, std::abs(u));
      if (d < 2 && n.reference_position[i][d] < 1e-9)
        across = std::max(across, std::abs(u));
    }
  return {{"motion across the planes", 0., across, 1e-18, "m", "constraint"},
          {"motion elsewhere", 1e-6, moved, 0., "m", "so that it moves",
           Check::Kind::at_least},
          {"energy kept", 1., world.total_energy() / before, 0.01, "1",
           "conservation"}};
}

/** A bar pulled apart by driven ends: the work done is the energy gained. */
std::vector<Check> pulled_bar()
{
  World world;
  BoxSpecification b;
  b.size = {{20e-3, 4e-3, 4e-3}};
  b.cell_size = 1e-3;
  FemOptions options;
  options.driven_boundary_ids = {1};
  options.driven_velocity = {{5., 0., 0.}};
  options.driven_components = {{true, false, false}};
  options.symmetry_boundary_ids = {0, 2, 4};
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  world.bodies.push_back(std::make_unique<FemBody>("bar", 0, make_graded_box(b),
                                                   elastic(0.3), options));
  world.distribute();
  world.stepper.initialize();
  const double before = world.total_energy();
  double worst = 0.;
  const double end = 20e-6;
  while (world.stepper.time() < end)
  {
    world.advance(0.5);
    worst = std::max(worst, std::abs(world.total_energy() - before));
  }
  const double work = world.ledger().external.value();
  // A wave of stress rho c_bar v runs to the symmetry plane and back: until it
  // returns at 2 L/c the end is held by sigma = rho c_bar v.
  const double rho = aluminum().density,
               c = std::sqrt(aluminum().young_modulus / rho),
               force = rho * c * 5. * 16e-6;
  return {{"energy gained minus work done, over the work", 0., worst / work,
           0.01, "1", "energy balance"},
          {"driven work until the wave is back over F v t",
           // The end nodes' own mass, half a cell, starts with v.
           1. - 0.5e-3 / (1.5 * 20e-3),
           [&]
           {
             World again;
             options.bulk_viscosity_linear = 0.06;
             again.bodies.push_back(std::make_unique<FemBody>(
                 "bar", 0, make_graded_box(b), elastic(0.), options));
             again.distribute();
             again.stepper.initialize();
             while (again.stepper.time() < 1.5 * 20e-3 / c)
               again.advance(0.5);
             return again.ledger().external.value() /
                    (force * 5. * again.stepper.time());
           }(),
           0.002, "1", "one-dimensional wave, nu = 0"}};
}

const RegisterProblem a({"fem-quarter-taylor",
                         "quarter of a Taylor bar against the whole", "quick",
                         quarter_taylor}),
    b({"fem-quarter-contact", "contact of quarter models against whole ones",
       "quick", quarter_contact}),
    c({"spg-symmetry-planes", "particles on planes of symmetry", "quick",
       spg_planes}),
    d({"fem-driven-bar", "work of a prescribed velocity", "quick", pulled_bar});
} // namespace
} // namespace sabot
