// What mirrors itself stays so: coarse balls fall on plates, node on node.
#include "sabot/geometry/round_bodies.h"
#include "verification/meeting.h"
#include "verification/problem.h"

#include <cstdio>

namespace sabot
{
namespace
{
/** A ball that falls on the middle of a plate; whole, or a quarter of both. */
struct Fall
{
  double radius, h, plate; // of cells [m]
  bool is_quarter = false;
};

constexpr double speed = 300.;

/** Of the ball after the impact [m/s]. */
std::array<double, 3> fall(const Fall &f)
{
  World world;
  FemOptions options;
  options.hourglass = "stiffness";
  // Shapes' own numbers of the planes x = 0 and y = 0.
  if (f.is_quarter)
    options.symmetry_boundary_ids = {0, 2};
  BoxSpecification box;
  box.size = {{24e-3, 24e-3, 4e-3}};
  box.center = {{0., 0., -2e-3}};
  if (f.is_quarter)
    for (int d = 0; d < 2; ++d)
    {
      box.size[d] *= 0.5;
      box.center[d] = 0.5 * box.size[d];
    }
  box.cell_size = f.plate;
  world.bodies.push_back(std::make_unique<FemBody>(
      "plate", 0, make_graded_box(box), elastic(0.3), options));
  if (f.is_quarter)
    options.symmetry_boundary_ids = {1, 2};
  options.initial_velocity = {{0., 0., -speed}};
  world.bodies.push_back(std::make_unique<FemBody>(
      "ball", 1,
      make_sphere(f.radius, {{0., 0., 1.1 * f.radius}}, f.h,
                  f.is_quarter ? 2 : 0),
      elastic(0.3), options));
  start_meeting(world);
  while (world.stepper.time() < 15e-6)
    world.advance(0.9);
  return world.bodies[1]->measure().velocity;
}

std::vector<Check> mirror()
{
  std::vector<Check> checks;
  for (Fall f : {Fall{3e-3, 1e-3, 1e-3}, Fall{3e-3, 1.5e-3, 1e-3},
                 Fall{3e-3, 1e-3, 2e-3}, Fall{2e-3, 1e-3, 1e-3}})
  {
    const auto v = fall(f);
    char text[80];
    std::snprintf(text, sizeof(text), "ball of %g mm, cells %g and %g mm, ",
                  1e3 * f.radius, 1e3 * f.h, 1e3 * f.plate);
    const std::string what = text;
    for (const int d : {0, 1})
      checks.push_back({what + "sideways along " + "xy"[d] + " over its speed",
                        0., v[d] / speed, 1e-9, "1", "it mirrors itself"});
    f.is_quarter = true;
    const auto quarter = fall(f);
    checks.push_back({what + "rebound of a quarter over that of the whole", 1.,
                      quarter[2] / v[2], 0.005, "1", "planes of symmetry"});
  }
  return checks;
}

const RegisterProblem a({"contact-mirror",
                         "coarse balls on plates stay their mirror images",
                         "quick", mirror});
} // namespace
} // namespace sabot
