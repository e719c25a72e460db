// The work that it takes to shear a block off, by nodal spacing and by the
// length over which the measure of failure is averaged.
#include "sabot/couplings/self_contact.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <cstring>

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
Shearing shear(const double h, const double failure_strain,
               const std::optional<double> &length)
{
  const double Lx = 9e-3, Ly = 3e-3, Lz = 12e-3, v = 60., grip = 3.01e-3;
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(failure_strain);
  options.nonlocal_length = length;
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
    n.velocity[i] = vec(v * z / (0.5 * Lz - grip), 0., 0.);
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

void add_checks(std::vector<Check> &checks, const double failure_strain,
                const std::optional<double> &length)
{
  char text[80];
  std::snprintf(text, sizeof(text), "strain %g, length %g mm", failure_strain,
                1e3 * length.value_or(0.));
  const std::string what =
      length ? text
             : std::string(text, std::strcspn(text, ",")) + ", no length";
  std::vector<double> works;
  for (const double h : {1e-3, 0.75e-3, 0.5e-3})
  {
    const Shearing s = shear(h, failure_strain, length);
    works.push_back(s.work);
    std::snprintf(text, sizeof(text), ", %g mm: ", 1e3 * h);
    const std::string at = what + text;
    checks.push_back({at + "work per area", 0., s.work * 1e-3, 0., "kJ/m2", "",
                      Check::Kind::reported});
    checks.push_back({at + "energy residual", 0.02, s.residual, 0., "1",
                      "work of the ends is what the block takes",
                      Check::Kind::at_most});
    checks.push_back({at + "stress at the end", 0., s.held, 0.05, "1",
                      "over Y/sqrt(3): it is sheared off"});
    checks.push_back({at + "bonds broken", 0., s.broken, 0., "1", "",
                      Check::Kind::reported});
  }
  const double mean = (works[0] + works[1] + works[2]) / 3.;
  double off = 0.;
  for (const double work : works)
    off = std::max(off, std::abs(work / mean - 1.));
  checks.push_back({what + ": work, largest difference to the mean over "
                           "spacings",
                    length ? 0.03 : 0., off, 0., "1",
                    length ? "the length sets the band" : "",
                    length ? Check::Kind::at_most : Check::Kind::reported});
}

std::vector<Check> spg_shear_plug()
{
  std::vector<Check> checks;
  for (const double failure_strain : {0.4, 0.2})
    for (const std::optional<double> &length :
         {std::optional<double>(), std::optional<double>(1e-3),
          std::optional<double>(2e-3)})
      add_checks(checks, failure_strain, length);
  return checks;
}

const RegisterProblem plug({"spg-shear-plug",
                            "work to shear a block off, by spacing", "long",
                            spg_shear_plug});
} // namespace
} // namespace sabot
