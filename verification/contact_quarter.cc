// Contact at planes of symmetry: quarters of models against wholes.
#include "sabot/base/text.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/particle_contact.h"
#include "verification/halves.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
struct Blow
{
  bool on_particles, is_round;
  double width, friction; // [m], coefficient
};

/** Of a box around the axis, or the quarter of it: size and center [m]. */
std::pair<std::array<double, 3>, std::array<double, 3>>
part_of(std::array<double, 3> size, const double z, const bool quarter)
{
  std::array<double, 3> center{{0., 0., z}};
  for (int d = 0; d < 2 && quarter; ++d)
  {
    size[d] *= 0.5;
    center[d] = 0.5 * size[d];
  }
  return {size, center};
}

HexMesh box_mesh(const std::array<double, 3> &size, const double z,
                 const double cell_size, const bool quarter)
{
  BoxSpecification box;
  std::tie(box.size, box.center) = part_of(size, z, quarter);
  box.cell_size = cell_size;
  return make_graded_box(box);
}

/** A plate of cells or particles, 1 mm apart. */
std::unique_ptr<Body> plate(const Blow &blow, const bool quarter)
{
  const std::array<double, 3> size{{12e-3, 12e-3, 2e-3}};
  if (blow.on_particles)
  {
    SpgOptions options;
    if (quarter)
      options.symmetry_faces = 1 | 4;
    const auto [its, center] = part_of(size, -1e-3, quarter);
    return std::make_unique<SpgBody>("plate", 0,
                                     make_box_cloud(center, its, 1e-3),
                                     taylor_copper(), options);
  }
  FemOptions options;
  if (quarter)
    options.symmetry_boundary_ids = {0, 2};
  return std::make_unique<FemBody>("plate", 0,
                                   box_mesh(size, -1e-3, 1e-3, quarter),
                                   taylor_copper(), options);
}

/** What falls on it, of cells, a box or a cylinder. */
std::unique_ptr<Body> block(const Blow &blow, const bool quarter)
{
  constexpr double length = 3.6e-3, z = 1.81e-3, cell_size = 1.2e-3;
  FemOptions options;
  options.initial_velocity = {{0., 0., -200.}};
  if (quarter && blow.is_round)
    options.symmetry_boundary_ids = {3, 4};
  else if (quarter)
    options.symmetry_boundary_ids = {0, 2};
  return std::make_unique<FemBody>(
      "block", 1,
      blow.is_round
          ? make_cylinder(0.5 * blow.width, length, 2, {{0., 0., z}}, cell_size,
                          quarter ? 2 : 0)
          : box_mesh({{blow.width, blow.width, length}}, z, cell_size, quarter),
      taylor_copper(), options);
}

void strike(World &world, const Blow &blow, const bool quarter)
{
  world.bodies.push_back(plate(blow, quarter));
  world.bodies.push_back(block(blow, quarter));
  ContactOptions options;
  if (blow.friction > 0.)
    options.friction = coulomb(blow.friction);
  world.couplings.push_back(std::make_unique<Contact>(
      "impact", world.pointers(), std::vector<ContactPair>{{0, 1}, {1, 0}},
      options, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

/** By steps of the same size to @p end [s]. */
void advance_together(World &whole, World &quarter, const double end)
{
  while (whole.stepper.time() < end)
  {
    const double dt = 0.7 * std::min(whole.stepper.propose(false).dt,
                                     quarter.stepper.propose(false).dt);
    for (World *const world : {&whole, &quarter})
    {
      world->stepper.advance(dt);
      world->stepper.update();
    }
  }
}

/** Largest distance between nodes of the quarter and those of the whole
    [m]. */
double worst_of(const World &whole, const World &quarter)
{
  double worst = 0.;
  for (int b = 0; b < 2; ++b)
    worst = std::max(worst,
                     largest_difference(*quarter.bodies[b], *whole.bodies[b]));
  return worst;
}

std::vector<Check> problem()
{
  std::vector<Check> checks;
  for (const bool on_particles : {false, true})
    for (const bool is_round : {false, true})
      for (const double width : {4.8e-3, 7.2e-3})
        for (const double friction : {0., 0.3})
        {
          const Blow blow{on_particles, is_round, width, friction};
          World whole, quarter;
          strike(whole, blow, false);
          strike(quarter, blow, true);
          advance_together(whole, quarter, 3e-6);
          // Friction of cells on cells sees which face of the whole was met
          // first.
          const bool is_exact = on_particles || friction == 0.;
          checks.push_back({std::string(is_round ? "cylinder" : "block") +
                                " of " + formatted("%g", 1e3 * width) +
                                " mm on " +
                                (on_particles ? "particles" : "cells") +
                                (friction > 0. ? ", friction" : "") +
                                ": positions over spacing",
                            0., worst_of(whole, quarter) / 1e-3,
                            is_exact ? 1e-8 : 1e-3, "1", "symmetry"});
          if (friction == 0.)
            checks.push_back({"speed lost by the whole", 70.,
                              200. + whole.bodies[1]->measure().velocity[2], 0.,
                              "m/s", "so that they have met",
                              Check::Kind::at_least});
        }
  return checks;
}

/** Two blocks of particles that may fail, the upper one the smaller. */
void strike_particles(World &world, const double friction,
                      const double critical, const bool quarter)
{
  for (const bool is_upper : {false, true})
  {
    SpgOptions options;
    options.initial_velocity = {{0., 0., is_upper ? -200. : 100.}};
    if (quarter)
      options.symmetry_faces = 1 | 4;
    if (critical > 0.)
      options.set_critical_plastic_strain(critical);
    const double width = is_upper ? 6e-3 : 8e-3;
    const auto [size, center] =
        part_of({{width, 8e-3, 3e-3}}, is_upper ? 1.51e-3 : -1.5e-3, quarter);
    world.bodies.push_back(std::make_unique<SpgBody>(
        is_upper ? "block" : "plate", world.bodies.size(),
        make_box_cloud(center, size, 1e-3), taylor_copper(), options));
  }
  ContactOptions options;
  if (friction > 0.)
    options.friction = coulomb(friction);
  world.couplings.push_back(std::make_unique<ParticleContact>(
      "impact", world.pointers(), std::vector<std::pair<int, int>>{{0, 1}},
      options, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

std::vector<Check> of_particles()
{
  std::vector<Check> checks;
  for (const double critical : {0., 0.05})
    for (const double friction : {0., 0.3})
    {
      World whole, quarter;
      strike_particles(whole, friction, critical, false);
      strike_particles(quarter, friction, critical, true);
      advance_together(whole, quarter, 3e-6);
      checks.push_back(
          {std::string(critical > 0. ? "failing " : "") + "blocks" +
               (friction > 0. ? ", friction" : "") + ": positions over spacing",
           0., worst_of(whole, quarter) / 1e-3, 1e-8, "1", "symmetry"});
      if (friction == 0.)
        checks.push_back({"speed lost by the whole", 70.,
                          200. + whole.bodies[1]->measure().velocity[2], 0.,
                          "m/s", "so that they have met",
                          Check::Kind::at_least});
      if (critical > 0.)
        checks.push_back({"share of failed bonds", 0.05,
                          measure(*whole.bodies[1], "bonds broken fraction"),
                          0., "1", "so that metal fails",
                          Check::Kind::at_least});
    }
  return checks;
}

const RegisterProblem particles(
    {"contact-quarter-particles",
     "blocks of particles that meet, quarters against wholes, also such that "
     "fail",
     "quick", of_particles});

const RegisterProblem
    registered({"contact-quarter",
                "blocks and cylinders on plates of cells and of particles, "
                "quarters against wholes",
                "quick", problem});
} // namespace
} // namespace sabot
