// What a plastic block of particles bears in shear: the yield stress in shear
// where its ends overlap, and what a flow over a few spacings costs above it.
#include "verification/problem.h"
#include "verification/world.h"

#include <cstdio>

namespace sabot
{
namespace
{
// Sheared 0.3 to 0.8 mm far, the ends of 12 mm face each other over this part.
constexpr double overlap = 1. - 0.55 / 12.;

/** Mean shear stress over the middle of a perfectly plastic block whose ends
    move apart along x, and the part of the work that the stabilization took. */
std::array<double, 2> shear(const double h)
{
  const double Lx = 12e-3, Ly = 3e-3, Lz = 6e-3, v = 30., grip = 1.01e-3;
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, {{Lx, Ly, Lz}}, h),
      hardening_aluminum(aluminum_yield_stress(), 0.), SpgOptions()));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  std::vector<std::size_t> upper;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double z = n.reference_position[i][2];
    n.velocity[i] = vec(2. * v * z / Lz, 0., 0.);
    if (std::abs(z) > 0.5 * Lz - grip)
    {
      n.velocity[i] = vec(z > 0. ? v : -v, 0., 0.);
      n.inertia[i] *= 1e9; // moves on as it does
      if (z > 0.)
        upper.push_back(i);
    }
  }
  world.stepper.initialize();
  double impulse = 0., time = 0.;
  while (2. * v * world.stepper.time() < 0.8e-3)
  {
    const double dt = world.advance(0.8);
    if (2. * v * world.stepper.time() < 0.3e-3)
      continue;
    for (const std::size_t i : upper)
      impulse -= n.force[i][0] * dt;
    time += dt;
  }
  const double stress = impulse / time / (Lx * Ly);
  return {{stress, measure(body, "stabilization energy") /
                       (measure(body, "stabilization energy") +
                        body.measure().internal_energy)}};
}

std::vector<Check> spg_limit_load()
{
  std::vector<Check> checks;
  const char *const source = "limit load of a J2 block";
  double excess[3];
  const double spacings[3] = {1e-3, 0.5e-3, 0.25e-3};
  for (int k = 0; k < 3; ++k)
  {
    const double h = spacings[k];
    const auto [stress, part] = shear(h);
    const double over =
        stress / (aluminum_yield_stress() / std::sqrt(3.) * overlap);
    excess[k] = over - 1.;
    char name[80];
    std::snprintf(name, sizeof(name), "%g spacings high: stress over its limit",
                  6e-3 / h);
    // The motions a discrete body has are some of all motions: by the upper
    // bound theorem it bears more, the less the finer it is.
    if (k < 2)
      checks.push_back(
          {name, 1., over, 0., "1", source, Check::Kind::reported});
    else
      checks.push_back({name, 1., over, 0.03, "1", source});
    std::snprintf(name, sizeof(name), "%g spacings: stabilization's work",
                  6e-3 / h);
    checks.push_back({name, 0., part, 0., "1", "", Check::Kind::reported});
  }
  checks.push_back({"order of the excess, 6 to 12 spacings", 1.,
                    std::log2(excess[0] / excess[1]), 0., "1", source,
                    Check::Kind::at_least});
  return checks;
}

const RegisterProblem load({"spg-limit-load", "limit load of a sheared block",
                            "long", spg_limit_load});
} // namespace
} // namespace sabot
