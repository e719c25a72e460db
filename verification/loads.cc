// Loads from outside: free fall, a suddenly loaded bar, a pressurized cylinder.
#include "sabot/bodies/rigid/rigid_body.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr double g = 9.81;

BoxSpecification block_at(const double x)
{
  BoxSpecification b;
  b.center = {{x, 0., 0.}};
  b.size = {{4e-3, 4e-3, 4e-3}};
  b.cell_size = 1e-3;
  return b;
}

/** Cells, particles, a rigid body and a tied pair, thrown upwards, fall again:
    on the parabola, without strain. */
std::vector<Check> free_fall()
{
  const std::array<double, 3> v{{1., -0.2, 0.5}};
  World world;
  FemOptions fem;
  fem.initial_velocity = v;
  SpgOptions spg;
  spg.initial_velocity = v;
  RigidOptions rigid;
  rigid.initial_velocity = v;
  world.bodies.push_back(std::make_unique<FemBody>(
      "cells", 0, make_graded_box(block_at(0.)), elastic(), fem));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "particles", 1,
      make_box_cloud(block_at(10e-3).center, block_at(0.).size, 1e-3),
      elastic(), spg));
  world.bodies.push_back(std::make_unique<RigidBody>(
      "rigid", 2, make_graded_box(block_at(20e-3)), elastic(), rigid));
  world.add_load("gravity", {{"Acceleration", "0, 0, -9.81 km/s^2"},
                             {"Course", "table"},
                             {"Times", "0 us, 50 us"},
                             {"Factors", "0, 2"}});
  world.distribute();
  world.stepper.initialize();
  const double kinetic = world.ledger().kinetic.value();
  while (world.stepper.time() < 80e-6)
    world.advance(0.9);
  const double t = world.stepper.time(), T = 50e-6, a = 1e3 * g;
  // 2 a t/T up to T, 2 a after it.
  const double speed = a * T + 2. * a * (t - T),
               depth = a * T * T / 3. + a * T * (t - T) + a * (t - T) * (t - T);
  std::vector<Check> checks;
  for (const auto &body : world.bodies)
  {
    double place = 0., velocity = 0.;
    const NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec x = n.position[i] - n.reference_position[i];
      const Vec exact = vec(v[0] * t, v[1] * t, v[2] * t - depth);
      place = std::max(place, norm(x - exact) / depth);
      velocity =
          std::max(velocity,
                   norm(n.velocity[i] - vec(v[0], v[1], v[2] - speed)) / speed);
    }
    // Trapezoids of dt = 0.1 us on a kink.
    checks.push_back({body->name + ": place, error over the depth", 0., place,
                      2e-5, "1", "integral of g(t)"});
    checks.push_back({body->name + ": velocity, error over the change", 0.,
                      velocity, 2e-5, "1", "integral of g(t)"});
  }
  const EnergyLedger e = world.ledger();
  const double gained = e.kinetic.value() - kinetic;
  checks.push_back({"work over kinetic energy gained", 1.,
                    e.external.value() / gained, 2e-5, "1", "energy balance"});
  checks.push_back({"internal energy over it", 0.,
                    world.internal_energy() / gained, 1e-9, "1",
                    "nothing deforms"});
  return checks;
}

const RegisterProblem a({"load-free-fall", "bodies of all kinds under gravity",
                         "quick", free_fall});
} // namespace
} // namespace sabot
