// Plane shocks in particles: the Hugoniot, and no sawtooth behind them.
#include "sabot/base/choice.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/balance.h"
#include "verification/problem.h"

#include <string>
#include <utility>

namespace sabot
{
namespace
{
/** As both metals flow at such strains and rates. */
constexpr double yield = 300e6;

/** A slab in uniaxial strain between planes of symmetry flies at the one at x =
    0, which is the impact of two. The end away from it is free. */
struct Slab
{
  World world;
  const SpgBody *body;
  std::unique_ptr<EnergyWatch> watch;

  Slab(const std::string &metal, const double length, const double speed,
       SpgOptions options)
  {
    constexpr double width = 0.3e-3, h = 0.1e-3;
    options.initial_velocity = {{-speed, 0., 0.}};
    options.symmetry_faces = 0b111101;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "slab", 0,
        make_box_cloud({{0.5 * length, 0.5 * width, 0.5 * width}},
                       {{length, width, width}}, h),
        std::make_shared<HardeningPlasticity>(
            elastic_constants(metal), HardeningParameters{yield, 0., 1.},
            std::make_shared<MieGruneisen>(
                mie_gruneisen_parameters(metal + "-eos"))),
        options));
    world.distribute();
    world.stepper.initialize();
    body = static_cast<const SpgBody *>(world.bodies[0].get());
  }
  void advance_to(const double time)
  {
    watch = std::make_unique<EnergyWatch>(world);
    while (world.stepper.time() < time)
    {
      world.advance(0.8);
      watch->look();
    }
  }
  /** Mean from 1 to 2.5 mm [Pa]. */
  double pressure() const
  {
    const NodalState &nodes = body->nodes();
    double sum = 0.;
    int n = 0;
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      if (nodes.position[i][0] > 1e-3 && nodes.position[i][0] < 2.5e-3)
      {
        for (int c = 0; c < 3; ++c)
          sum -= body->stress(c, i) / 3.;
        ++n;
      }
    return sum / n;
  }
  /** Stabilization over internal energy. */
  double sawtooth() const
  {
    const EnergyLedger energy = world.ledger();
    return energy.stabilization.value() / energy.internal.value();
  }
};

/** 0.8 us after a slab met its image. */
void add_shock(std::vector<Check> &checks, const std::string &metal,
               const double speed, const SpgOptions &options,
               const std::string &how)
{
  const MieGruneisenParameters shock = mie_gruneisen_parameters(metal + "-eos");
  const double expected =
      shock.density * (shock.sound_speed + shock.shock_slope * speed) * speed;
  Slab slab(metal, 8e-3, speed, options);
  slab.advance_to(0.8e-6);
  const std::string which =
      metal + " at 2 x " + std::to_string(int(speed)) + " m/s, " + how + ": ";
  checks.push_back({which + "pressure behind the shock", expected,
                    slab.pressure(), 0.03 * expected, "Pa",
                    "rho0 Us up, Us = c0 + s up"});
  checks.push_back({which + "stabilization over internal energy", 0.,
                    slab.sawtooth(), 0.02, "1", "nothing is bent",
                    Check::Kind::at_most});
}

/** Metal whose bonds can fail; friction where they have. */
SpgOptions failing()
{
  SpgOptions options;
  options.residual_strength = choose<ResidualStrength>("friction");
  return options;
}

/** The relief from the free end comes back to the plane and tears the slab.
    Bonds that break jolt what is beside them, so that some stabilization is
    due: what there is where kernels never follow the motion, which then freezes
    no sawtooth. */
void add_spall(std::vector<Check> &checks)
{
  SpgOptions options = failing();
  options.failure_criterion = choose<FailureCriterion>(
      "maximum principal stress", {{"Critical principal stress", "1 GPa"}});
  SpgOptions fixed = options;
  fixed.kernel_update_interval = 1000000;
  fixed.kernel_update_change = 10.;
  Slab slab("al6061-t6", 4e-3, 500., options),
      reference("al6061-t6", 4e-3, 500., fixed);
  for (Slab *const s : {&slab, &reference})
    s->advance_to(2e-6);
  const std::string which = "al6061-t6 at 2 x 500 m/s, torn at 1 GPa: ";
  checks.push_back(
      {which + "bonds broken", 1., measure(*slab.body, "bonds broken"), 0., "1",
       "the relief of 8 GPa is tension beyond", Check::Kind::at_least});
  checks.push_back({which + "stabilization over internal energy",
                    reference.sawtooth(), slab.sawtooth(), 0.02, "1",
                    "where no kernel follows", Check::Kind::at_most});
  checks.push_back({which + "energy residual", reference.watch->residual(),
                    slab.watch->residual(), 1e-3, "1",
                    "where no kernel follows", Check::Kind::at_most});
}

std::vector<Check> shocks()
{
  const std::string al = "al6061-t6", copper = "copper-ofhc";
  std::vector<Check> checks;
  for (const auto &[metal, speed] :
       {std::pair{al, 250.}, {al, 500.}, {al, 750.}, {copper, 500.}})
  {
    for (const unsigned int interval : {20u, 30u, 100u})
    {
      SpgOptions options;
      options.kernel_update_interval = interval;
      add_shock(checks, metal, speed, options,
                "updates every " + std::to_string(interval) + " steps");
    }
    SpgOptions options = failing();
    options.set_critical_plastic_strain(1.);
    add_shock(checks, metal, speed, options, "bonds that could fail");
  }
  add_spall(checks);
  return checks;
}

const RegisterProblem a({"spg-plate-impact",
                         "plane shocks in particles, at several intervals of "
                         "kernel updates",
                         "quick", shocks});
} // namespace
} // namespace sabot
