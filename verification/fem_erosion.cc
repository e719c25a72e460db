// Eroding hexahedra: what a torn bar and a bursting block keep.
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** Kinematic hardening. */
std::shared_ptr<const Material> torn_metal()
{
  return hardening_aluminum(300e6, 100e6, 0.);
}

HexMesh bar_mesh(const double length)
{
  BoxSpecification b;
  b.size = {{length, 4e-3, 4e-3}};
  b.cell_size = 1e-3;
  return make_graded_box(b);
}

/** Sum of the area vectors and of all areas of the contact surface. */
std::array<double, 2> surface_area(const Body &body)
{
  Vec sum{};
  double total = 0.;
  const ContactSurface surface = body.contact_surface();
  for (const auto &face : surface.faces)
  {
    const auto &x = body.nodes().position;
    const Vec area =
        0.5 * cross(x[face[2]] - x[face[0]], x[face[3]] - x[face[1]]);
    sum += area;
    total += norm(area);
  }
  return {{norm(sum), total}};
}

/** Ends driven apart until the bar breaks by erosion. */
std::vector<Check> torn_bar()
{
  World world;
  FemOptions options;
  options.driven_boundary_ids = {1};
  options.driven_velocity = {{60., 0., 0.}};
  options.clamped_boundary_ids = {0};
  options.erosion_plastic_strain = 0.3;
  world.bodies.push_back(std::make_unique<FemBody>("bar", 0, bar_mesh(20e-3),
                                                   torn_metal(), options));
  world.distribute();
  Body &body = *world.bodies[0];
  world.stepper.initialize();
  const double before = world.total_energy(), mass = body.measure().mass;
  double worst = 0.;
  while (world.stepper.time() < 100e-6)
  {
    world.advance(0.8);
    worst = std::max(worst, std::abs(world.total_energy() - before));
  }
  const EnergyLedger e = world.ledger();
  const double work = e.external.value();
  const double eroded = body.measure().eroded_mass,
               cells = measure(body, "eroded cells");
  const auto area = surface_area(body);
  return {{"energy not accounted for, over the work", 0., worst / work, 0.01,
           "1", "energy balance over every erosion"},
          {"eroded cells", 16., cells, 0., "1",
           "a whole section of 4 x 4 cells at least", Check::Kind::at_least},
          {"eroded mass over mass of the eroded cells", 1.,
           eroded / (cells * aluminum().density * 1e-9), 1e-12, "1",
           "definition"},
          {"mass of attached and free nodes over the mass", 1.,
           (body.measure().mass + measure(body, "free node mass")) / mass,
           1e-12, "1", "conservation of mass"},
          {"largest plastic strain of the cells left", 0.3,
           measure(body, "plastic strain max"), 0., "1", "criterion",
           Check::Kind::at_most},
          {"eroded energy", 0., e.eroded.value(), 0., "J", "it is counted",
           Check::Kind::at_least},
          {"sum of the area vectors over the area", 0., area[0] / area[1],
           1e-12, "1", "the surface is closed"}};
}

/** A free block that breaks up keeps its momentum, free nodes included. */
std::vector<Check> burst_block()
{
  World world;
  FemOptions options;
  options.erosion_plastic_strain = 0.05;
  options.initial_velocity = {{100., 0., 0.}};
  world.bodies.push_back(std::make_unique<FemBody>("block", 0, bar_mesh(6e-3),
                                                   torn_metal(), options));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    const Vec x = n.reference_position[i];
    n.velocity[i] += vec(4e4 * x[0], 6e4 * x[1] + 2e7 * x[0] * x[2], 0.);
  }
  world.stepper.initialize();
  const auto before = world.momenta();
  const double energy = world.total_energy();
  double worst = 0.;
  for (int step = 0; step < 800; ++step)
  {
    world.advance(0.2);
    worst = std::max(worst, std::abs(world.total_energy() / energy - 1.));
  }
  const auto after = world.momenta();
  double reported = 0.;
  for (const char d : {'x'})
    reported =
        measure(body, std::string("eroded momentum ") + d) +
        body.measure().mass * measure(body, std::string("velocity ") + d);
  return {{"eroded cells", 4., measure(body, "eroded cells"), 0., "1",
           "so that there is something to lose", Check::Kind::at_least},
          {"free node mass", 1e-9, measure(body, "free node mass"), 0., "kg",
           "some nodes fly alone", Check::Kind::at_least},
          {"momentum after over before", 1., after[0] / before[0], 1e-12, "1",
           "conservation"},
          {"reported momentum, attached and free, over it", 1.,
           reported / before[0], 1e-12, "1", "accounting"},
          {"energy, largest relative change", 0., worst, 0.01, "1",
           "conservation"}};
}

/** Two cells squeezed by a driven face in steps that are too large. */
std::vector<Check> inversion()
{
  const auto squeeze =
      [](const FemOptions::Inversion reaction, std::string &message)
  {
    World world;
    FemOptions options;
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    options.inversion = reaction;
    options.clamped_boundary_ids = {0};
    options.driven_boundary_ids = {1};
    options.driven_velocity = {{-2e4, 0., 0.}}; // three times the wave speed
    BoxSpecification b;
    b.size = {{2e-3, 1e-3, 1e-3}};
    b.cell_size = 1e-3;
    world.bodies.push_back(std::make_unique<FemBody>(
        "cells", 0, make_graded_box(b), elastic(), options));
    world.distribute();
    world.stepper.initialize();
    double eroded = 0.;
    try
    {
      for (int step = 0; step < 20 && eroded == 0.; ++step)
      {
        world.advance(0.9);
        if (reaction == FemOptions::Inversion::erode)
          eroded = measure(*world.bodies[0], "eroded cells");
      }
    }
    catch (const PhysicsError &e)
    {
      message = e.what();
    }
    return reaction == FemOptions::Inversion::erode
               ? eroded
               : double(world.stepper.time());
  };
  std::string stopped, eroding, shrinking;
  squeeze(FemOptions::Inversion::stop, stopped);
  const double eroded = squeeze(FemOptions::Inversion::erode, eroding);
  squeeze(FemOptions::Inversion::shrink, shrinking);
  const bool named = stopped.find("body cells, cell ") != std::string::npos &&
                     stopped.find("about to turn") != std::string::npos;
  return {
      {"stop: the message names the cell before it inverts", 1., double(named),
       0., "1", "detection"},
      {"erode: cells eroded", 1., eroded, 0., "1", "detection",
       Check::Kind::at_least},
      {"erode: no error", 1., double(eroding.empty()), 0., "1", "detection"},
      {"shrink: no error", 1., double(shrinking.empty()), 0., "1",
       "a quarter of the volume per step at most"}};
}

const RegisterProblem a({"fem-torn-bar", "a bar pulled until it erodes",
                         "quick", torn_bar}),
    b({"fem-burst-block", "momentum of an eroding block", "quick",
       burst_block}),
    c({"fem-inversion", "cells about to turn inside out", "quick", inversion});
} // namespace
} // namespace sabot
