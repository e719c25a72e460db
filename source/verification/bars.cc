#include "sabot/couplings/contact.h"
#include "sabot/verification/driven.h"
#include "sabot/verification/problem.h"

namespace sabot
{
namespace
{
const double rho = 2700., E = 68.9e9;

/** A smooth push on the end of a slender free bar travels at sqrt(E/rho). */
std::vector<Check> bar_wave()
{
  const double h = 1e-3, c = std::sqrt(E / rho);
  const int n = 200;
  const double rise = 20e-6, speed = 1.;
  World world;
  world.bodies.push_back(std::make_unique<DrivenFemBody>(
      "bar", 0, make_bar(0., n, h), elastic(0.33), FemOptions(),
      [=](NodalState &nodes, const double t)
      {
        const double ramp =
            t < rise ? 0.5 * (1. - std::cos(M_PI * t / rise)) : 1.;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          if (nodes.reference_position[i][0] < 0.5 * h)
            nodes.velocity[i] =
                vec(speed * ramp, nodes.velocity[i][1], nodes.velocity[i][2]);
      }));
  world.distribute();
  world.integrator.initialize();
  Crossing near{0.5 * speed}, far{0.5 * speed};
  const auto &bar = static_cast<const FemBody &>(*world.bodies[0]);
  while (world.integrator.time < 38e-6)
  {
    world.advance(0.9);
    near.sample(world.integrator.time, velocity_at(bar, 30e-3, 0.5 * h));
    far.sample(world.integrator.time, velocity_at(bar, 130e-3, 0.5 * h));
  }
  double stress = 0.;
  for (int e = 30; e < 50; ++e)
    stress -= bar.stress(0, e) / 20.;
  return {{"wave speed", c, 100e-3 / (far.time - near.time), 5e-3 * c, "m/s",
           "sqrt(E/rho)"},
          {"stress", rho * c * speed, stress, 0.01 * rho * c * speed, "Pa",
           "rho c v"}};
}

/** Two equal bars, nu = 0 so that one dimension is exact, meet at v. */
std::vector<Check> saint_venant()
{
  const double h = 1e-3, v = 10., c = std::sqrt(E / rho);
  const int n = 100;
  const double length = n * h;
  World world;
  for (const int side : {-1, 1})
  {
    FemOptions options;
    if (side < 0)
      options.initial_velocity = {{v, 0., 0.}};
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        side < 0 ? "striker" : "bar", world.bodies.size(),
        make_bar(side < 0 ? -length : 0., n, h), elastic(0.), options,
        [](NodalState &, const double) {}));
  }
  auto contact = std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD);
  world.couplings.push_back(std::move(contact));
  world.distribute();
  world.integrator.initialize();
  const double energy = world.total_energy();
  const auto &bar = static_cast<const FemBody &>(*world.bodies[1]);
  double stress = 0.;
  int samples = 0;
  // The bars part when their faces do.
  double parted = std::nan("");
  while (world.integrator.time < 3. * length / c)
  {
    world.advance(0.9);
    const double t = world.integrator.time;
    if (t > 0.7 * length / c && t < 0.9 * length / c)
    {
      for (int e = 30; e < 50; ++e)
        stress -= bar.stress(0, e) / 20.;
      ++samples;
    }
    const double left = velocity_at(*world.bodies[0], 0., 0.5 * h),
                 right = velocity_at(bar, 0., 0.5 * h);
    if (std::isnan(parted) && t > length / c && right - left > 0.5 * v)
      parted = t;
  }
  return {{"stress", 0.5 * rho * c * v, stress / samples,
           0.01 * 0.5 * rho * c * v, "Pa", "rho c v/2 (St-Venant)"},
          {"contact time", 2. * length / c, parted, 0.02 * 2. * length / c, "s",
           "2 L/c"},
          {"velocity of the struck bar", v, measure(bar, "velocity x"),
           0.01 * v, "m/s", "equal bars exchange velocities"},
          {"velocity of the striker", 0.,
           measure(*world.bodies[0], "velocity x"), 0.01 * v, "m/s",
           "equal bars exchange velocities"},
          {"energy change", 0., world.total_energy() / energy - 1., 1e-3, "1",
           "energy balance"}};
}

const RegisterProblem wave({"bar-wave", "slender elastic bar, driven end",
                            "quick", bar_wave});
const RegisterProblem impact({"saint-venant-impact",
                              "two equal elastic bars meet", "quick",
                              saint_venant});
} // namespace
} // namespace sabot
