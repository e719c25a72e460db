// Plane shocks in particles: the Hugoniot, and no sawtooth behind them.
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <utility>

namespace sabot
{
namespace
{
/** What a slab is 0.8 us after it met its image. */
struct Shocked
{
  double pressure = 0.; // from 1 to 2.5 mm, mean [Pa]
  double sawtooth;      // stabilization over internal energy
};

/** A slab in uniaxial strain between planes of symmetry flies at the one at x =
    0, which is the impact of two. @p interval: of kernel updates, in steps. */
Shocked shocked_slab(const MieGruneisenParameters &shock,
                     const ElasticConstants &elastic, const double yield,
                     const double speed, const unsigned int interval)
{
  constexpr double length = 8e-3, width = 0.3e-3, h = 0.1e-3;
  SpgOptions options;
  options.initial_velocity = {{-speed, 0., 0.}};
  options.symmetry_faces = 0b111101;
  options.kernel_update_interval = interval;
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "slab", 0,
      make_box_cloud({{0.5 * length, 0.5 * width, 0.5 * width}},
                     {{length, width, width}}, h),
      std::make_shared<HardeningPlasticity>(
          elastic, HardeningParameters{yield, 0., 1.},
          std::make_shared<MieGruneisen>(shock)),
      options));
  world.distribute();
  world.stepper.initialize();
  while (world.stepper.time() < 0.8e-6)
    world.advance(0.8);
  const SpgBody &slab = static_cast<const SpgBody &>(*world.bodies[0]);
  const NodalState &nodes = slab.nodes();
  const EnergyLedger energy = world.ledger();
  Shocked found{0., energy.stabilization.value() / energy.internal.value()};
  int n = 0;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (nodes.position[i][0] > 1e-3 && nodes.position[i][0] < 2.5e-3)
    {
      for (int c = 0; c < 3; ++c)
        found.pressure -= slab.stress(c, i) / 3.;
      ++n;
    }
  found.pressure /= n;
  return found;
}

std::vector<Check> shocks()
{
  // As both flow at such strains and rates.
  constexpr double yield = 300e6;
  const std::string al = "al6061-t6", copper = "copper-ofhc";
  std::vector<Check> checks;
  for (const auto &[metal, speed] :
       {std::pair{al, 250.}, {al, 500.}, {al, 750.}, {copper, 500.}})
  {
    const MieGruneisenParameters shock =
        mie_gruneisen_parameters(metal + "-eos");
    const double expected =
        shock.density * (shock.sound_speed + shock.shock_slope * speed) * speed;
    for (const unsigned int interval : {20u, 30u, 100u})
    {
      const Shocked got =
          shocked_slab(shock, elastic_constants(metal), yield, speed, interval);
      const std::string which =
          metal + " at 2 x " + std::to_string(int(speed)) +
          " m/s, updates every " + std::to_string(interval) + " steps: ";
      checks.push_back({which + "pressure behind the shock", expected,
                        got.pressure, 0.03 * expected, "Pa",
                        "rho0 Us up, Us = c0 + s up"});
      checks.push_back({which + "stabilization over internal energy", 0.,
                        got.sawtooth, 0.02, "1", "nothing is bent",
                        Check::Kind::at_most});
    }
  }
  return checks;
}

const RegisterProblem a({"spg-plate-impact",
                         "plane shocks in particles, at several intervals of "
                         "kernel updates",
                         "quick", shocks});
} // namespace
} // namespace sabot
