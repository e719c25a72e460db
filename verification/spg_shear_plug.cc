// The work that it takes to shear a layer of particles off, by nodal spacing:
// the part of a plug's energy that follows the spacing.
#include "sabot/couplings/self_contact.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
struct Shearing
{
  double work; // of the driven ends per sheared area [J/m^2]
  double broken;
  double residual; // of the energy balance, over the work
  double held;     // shear stress that is left at the end, over the yield's
};

/** A block between two ends that move along x at +-v until its middle has
    failed. */
Shearing shear(const double h, const double failure_strain)
{
  const double Lx = 10e-3, Ly = 3e-3, Lz = 8e-3, v = 60., grip = 1.01e-3;
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(failure_strain);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, {{Lx, Ly, Lz}}, h),
      metal("al6061-t6"), options));
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      SelfContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  std::vector<std::size_t> driven;
  std::vector<double> speed(n.n_owned, 0.);
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double z = n.reference_position[i][2];
    n.velocity[i] = vec(2. * v * z / Lz, 0., 0.);
    if (std::abs(z) > 0.5 * Lz - grip)
    {
      speed[i] = z > 0. ? v : -v;
      n.velocity[i] = vec(speed[i], 0., 0.);
      n.inertia[i] *= 1e9; // moves on as it does
      driven.push_back(i);
    }
  }
  world.stepper.initialize();
  // Motion of what is not driven, and all but motion of everything.
  const auto energy = [&]
  {
    double kinetic = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (speed[i] == 0.)
        kinetic += 0.5 * n.inertia[i] * dot(n.velocity[i], n.velocity[i]);
    return kinetic + world.internal_energy() + world.contact_energy();
  };
  const double before = energy();
  double work = 0., force = 0., old_force = 0., held = 0.;
  int n_last = 0;
  const double distance = 7e-3; // of the ends, relative: failed by then
  const auto moved = [&] { return 2. * v * world.stepper.time(); };
  while (moved() < distance)
  {
    const double dt = world.advance(0.8);
    old_force = force;
    force = 0.;
    for (const std::size_t i : driven)
      force -= n.force[i][0] * speed[i] / v;
    work += 0.5 * (old_force + force) * v * dt;
    if (moved() > 0.9 * distance)
      held += 0.5 * force, ++n_last;
  }
  const double strength = aluminum_yield_stress() / std::sqrt(3.) * Lx * Ly;
  return {work / (Lx * Ly), body.measure().bonds_broken_fraction,
          std::abs(energy() - before - work) / work, held / n_last / strength};
}

std::vector<Check> spg_shear_plug()
{
  std::vector<Check> checks;
  for (const double failure_strain : {0.4, 0.2})
  {
    std::vector<double> works;
    for (const double h : {1e-3, 0.75e-3, 0.5e-3})
    {
      const Shearing s = shear(h, failure_strain);
      works.push_back(s.work);
      char name[80];
      std::snprintf(name, sizeof(name), "strain %g, %g mm: work per area",
                    failure_strain, 1e3 * h);
      checks.push_back(
          {name, 0., s.work * 1e-3, 0., "kJ/m2", "", Check::Kind::reported});
      std::snprintf(name, sizeof(name), "strain %g, %g mm: energy residual",
                    failure_strain, 1e3 * h);
      checks.push_back({name, 0.02, s.residual, 0., "1",
                        "work of the ends is what the block takes",
                        Check::Kind::at_most});
      std::snprintf(name, sizeof(name), "strain %g, %g mm: stress at the end",
                    failure_strain, 1e3 * h);
      checks.push_back(
          {name, 0., s.held, 0.05, "1", "over Y/sqrt(3): it is sheared off"});
      std::snprintf(name, sizeof(name), "strain %g, %g mm: bonds broken",
                    failure_strain, 1e3 * h);
      checks.push_back(
          {name, 0., s.broken, 0., "1", "", Check::Kind::reported});
    }
    checks.push_back(
        {"work at 0.5 mm over work at 1 mm", 0., works[2] / works[0], 0., "1",
         "0.5: proportional to the spacing", Check::Kind::reported});
  }
  return checks;
}

const RegisterProblem plug({"spg-shear-plug",
                            "work to shear a block off, by spacing", "long",
                            spg_shear_plug});
} // namespace
} // namespace sabot
