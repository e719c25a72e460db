// A pulse through a block whose cells turn into particles under it.
#include "verification/convert.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double cell = 1e-3; // [m]

/** Cells whose end at x = 0 moves as a burst of two periods, then is held. */
class DrivenCells : public FemBody
{
public:
  template <typename... Arguments>
  DrivenCells(const double period, Arguments &&...arguments)
      : FemBody(std::forward<Arguments>(arguments)...), period(period)
  {
  }
  void impose_velocities(const double time) override
  {
    FemBody::impose_velocities(time);
    const double window = std::sin(0.5 * M_PI * time / period);
    const double v = time < 2. * period
                         ? window * window * std::sin(2. * M_PI * time / period)
                         : 0.;
    NodalState &n = nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
      if (n.reference_position[i][0] < 1e-9)
        n.velocity[i] = vec(v, 0., 0.);
  }

private:
  const double period;
};

/** Particles that nobody drives, made like DrivenCells. */
class FreeParticles : public SpgBody
{
public:
  template <typename... Arguments>
  FreeParticles(const double, Arguments &&...arguments)
      : SpgBody(std::forward<Arguments>(arguments)...)
  {
  }
};

struct Passed
{
  // Over the energy sent in: what comes back, what stresses and velocities
  // lose.
  double reflected, lost, kinetic, residual;
};

/** A plane wave of @p n cells per length. All cells beyond four lengths turn at
    once while the pulse lies across the border, or one layer after the other
    ahead of it. */
Passed pass(const int n, const bool at_once, const unsigned int ratio)
{
  const double length = n * cell, period = length / elastic()->sound_speed();
  World world;
  ConvertingOptions options;
  if (ratio > 1)
    options.spacing = cell / ratio;
  options.fem.bulk_viscosity_linear = options.fem.bulk_viscosity_quadratic = 0.;
  options.fem.symmetry_boundary_ids = {2, 3, 4, 5};
  options.spg.bulk_viscosity_linear = options.spg.bulk_viscosity_quadratic = 0.;
  const double border = 4. * length, end = 9. * length;
  const auto where = add_converting<DrivenCells, FreeParticles>(
      world, block_mesh({{end, cell, cell}}, {{0.5 * end, 0., 0.}}, cell),
      elastic(), options, period);
  join_converting(world);
  world.distribute();
  world.stepper.initialize();
  while (world.stepper.time() < 2. * period)
    world.advance(0.9);
  const double sent = world.total_energy();
  double worst = 0.;
  while (world.stepper.time() < 8. * period)
  {
    const double front = world.stepper.time() / period * length;
    if (at_once && world.stepper.time() >= 5. * period)
      *where = [=](const Place &x) { return x[0] > border; };
    if (!at_once)
      *where = [=](const Place &x)
      { return x[0] > border && x[0] < front + 2. * cell; };
    world.advance(0.9);
    worst = std::max(worst, std::abs(world.total_energy() - sent) / sent);
  }
  EnergyLedger behind;
  world.bodies[0]->add_energies(behind);
  return {behind.total().value() / sent,
          find_measure(world.couplings[0]->measure(), "energy lost by means") /
              sent,
          ratio > 1 ? find_measure(world.couplings[0]->measure(),
                                   "kinetic energy lost to lattices") /
                          sent
                    : 0.,
          worst};
}

std::vector<Check> pulse()
{
  std::vector<Check> checks;
  for (const int n : {10, 20})
    for (const bool at_once : {true, false})
    {
      const Passed p = pass(n, at_once, 1);
      const std::string what = std::to_string(n) + " cells per wave, " +
                               (at_once ? "at once: " : "layer by layer: ");
      checks.push_back({what + "energy that comes back", 0., p.reflected, 0.01,
                        "1", "of what was sent", Check::Kind::at_most});
      // Only ten cells a wave under which all turns at once lose more.
      checks.push_back({what + "energy lost by means", 0., std::abs(p.lost),
                        n == 10 && at_once ? 3e-3 : 1e-3, "1", "",
                        Check::Kind::at_most});
      checks.push_back({what + "energy residual", 0., p.residual, 5e-3, "1", "",
                        Check::Kind::at_most});
    }
  // Cells that are split: it is the length in cells that counts.
  for (const unsigned int ratio : {2, 3})
    for (const bool at_once : {true, false})
    {
      const Passed p = pass(10, at_once, ratio);
      const std::string what = "10 cells per wave, split by " +
                               std::to_string(ratio) +
                               (at_once ? ", at once: " : ", layer by layer: ");
      checks.push_back({what + "energy that comes back", 0., p.reflected, 2e-3,
                        "1", "of what was sent", Check::Kind::at_most});
      checks.push_back({what + "energy lost", 0.,
                        std::abs(p.lost) + std::abs(p.kinetic),
                        at_once ? 5e-3 : 1e-4, "1", "", Check::Kind::at_most});
      checks.push_back({what + "energy residual", 0., p.residual, 1e-3, "1", "",
                        Check::Kind::at_most});
    }
  return checks;
}

/** The same where cells are split: by how much, and how long a wave is. */
std::vector<Check> table()
{
  std::vector<Check> checks;
  for (const int n : {5, 10, 20})
    for (const bool at_once : {true, false})
      for (const unsigned int ratio : {1, 2, 3, 4})
      {
        const Passed p = pass(n, at_once, ratio);
        const std::string what = std::to_string(n) + " cells per wave, " +
                                 (at_once ? "at once" : "layer by layer") +
                                 ", split by " + std::to_string(ratio) + ": ";
        const auto report = [&](const std::string &name, const double value)
        {
          checks.push_back({what + name, 0., value, 0., "of what was sent", "",
                            Check::Kind::reported});
        };
        report("energy that comes back", p.reflected);
        report("energy lost by means", p.lost);
        report("kinetic energy lost to lattices", p.kinetic);
        report("energy residual", p.residual);
      }
  return checks;
}

const RegisterProblem registered_table(
    {"convert-pulse-table",
     "Elastic pulse through a block whose cells are split into lattices under "
     "it, by ratio and length.",
     "long", table});

const RegisterProblem registered(
    {"convert-pulse",
     "Elastic pulse through a block whose cells turn into particles under it.",
     "quick", pulse});
} // namespace
} // namespace sabot
