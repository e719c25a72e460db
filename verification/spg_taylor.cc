// The copper Taylor bar of particles at three spacings.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <cstdio>
#include <ctime>

namespace sabot
{
namespace
{
/** What a copper bar looks like after 80 us. */
struct Bar
{
  double length = 0., foot_radius = 0., plastic_strain = 0.;
  double energy_residual = 0.,
         stabilization_share = 0.; // of the initial energy
  double penetration = 0.;         // over spacing
  double cpu = 0.;                 // [s]
  double n_particles = 0.;
};

/** Quarter of the bar (R 3.2, L 32.4 mm, 227 m/s) on a frictionless rigid wall
    by contact, or with its foot held in the plane. The default settings but the
    step factor: the shorter the step, the stiffer contact may be. */
Bar strike(const double h, const bool by_contact, const double step_factor)
{
  const double R = 3.2e-3, L = 32.4e-3;
  const std::clock_t start = std::clock();
  World world;
  SpgOptions options;
  options.initial_velocity = {{0., 0., -227.}};
  options.symmetry_faces = 1u << 3 | 1u << 4;
  if (!by_contact)
    options.symmetry_faces |= 1u << 0; // the struck face of make_cylinder()
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0,
      make_mesh_cloud(make_cylinder(R, L, 2, {{0., 0., 0.5 * L}}, h, 2)),
      taylor_copper(), options));
  if (by_contact)
  {
    // Reaches beyond the planes of symmetry, so that no node is near its rim.
    BoxSpecification wall;
    wall.size = {{24e-3, 24e-3, 2e-3}};
    wall.center = {{8e-3, 8e-3, -1e-3}};
    wall.cell_size = 1e-3;
    RigidOptions fixed;
    fixed.is_prescribed = true;
    world.bodies.push_back(std::make_unique<RigidBody>(
        "wall", 1, make_graded_box(wall), elastic(), fixed));
    const std::vector<ContactPair> pairs = {{1, 0}};
    world.couplings.push_back(std::make_unique<Contact>(
        "impact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
  }
  world.distribute();
  world.stepper.initialize();
  const Body &bar = *world.bodies[0];
  const double before = world.total_energy();
  Bar result;
  while (world.stepper.time() < 80e-6)
  {
    world.advance(step_factor);
    if (world.stepper.steps() % 50 == 0)
      result.energy_residual = std::max(
          result.energy_residual, std::abs(world.total_energy() / before - 1.));
  }
  double low = 1e300, high = -1e300;
  const NodalState &n = bar.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec x = n.position[i];
    low = std::min(low, x[2]);
    high = std::max(high, x[2]);
    // The rim nodes of the polygon start a little outside of the circle.
    result.foot_radius = std::max(result.foot_radius, std::hypot(x[0], x[1]));
  }
  result.length = high - low;
  result.plastic_strain = measure(bar, "plastic strain max");
  result.stabilization_share = measure(bar, "stabilization energy") / before;
  if (by_contact)
    result.penetration = world.couplings[0]->measure()[0].value;
  result.n_particles = double(n.n_owned);
  result.cpu = double(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

std::vector<Check> taylor()
{
  std::vector<Check> checks;
  const char *const source = "code comparison: Sierra/SM, Foulk et al. 2021";
  const auto strike_and_check =
      [&](const double h, const bool by_contact, const double step_factor)
  {
    const Bar bar = strike(h, by_contact, step_factor);
    char name[80];
    std::snprintf(name, sizeof(name),
                  "h = %.2f mm%s, step factor %.1f: ", 1e3 * h,
                  by_contact ? "" : ", held", step_factor);
    const auto report = [&](const char *const what, const double value,
                            const double expected, const char *const unit)
    {
      checks.push_back({std::string(name) + what, expected, value, 0., unit,
                        source, Check::Kind::reported});
    };
    const bool is_judged = by_contact && step_factor < 0.9;
    const auto check =
        [&](const char *const what, const double value, const double expected)
    {
      if (!is_judged)
        return report(what, value, expected, "mm");
      checks.push_back(
          {std::string(name) + what, expected, value, 0.15, "mm", source});
    };
    check("length", 1e3 * bar.length, 21.42);
    check("foot radius", 1e3 * bar.foot_radius, 7.22);
    report("largest plastic strain", bar.plastic_strain, 3., "1");
    report("stabilization energy over the initial one", bar.stabilization_share,
           0., "1");
    if (by_contact)
      report("deepest penetration over spacing", bar.penetration, 0., "1");
    report("particles of the quarter", bar.n_particles, 0., "1");
    report("CPU time", bar.cpu, 0., "s");
    checks.push_back({std::string(name) + "energy residual", 0.,
                      bar.energy_residual, 0.01, "1", "conservation"});
  };
  for (const double h : {0.8e-3, 0.53e-3, 0.4e-3})
    strike_and_check(h, true, 0.5);
  strike_and_check(0.53e-3, true, 0.9);
  strike_and_check(0.53e-3, false, 0.9);
  return checks;
}

const RegisterProblem registered({"spg-taylor",
                                  "copper Taylor bar of particles on a rigid "
                                  "wall, three spacings",
                                  "long", taylor});
} // namespace
} // namespace sabot
