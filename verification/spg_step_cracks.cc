// The stable step of metal that cracks, gapes and closes again.
#include "sabot/base/choice.h"
#include "sabot/base/exact_sum.h"
#include "sabot/base/text.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/stiffness_bound.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** How a block fared that flies apart and is thrown back together. */
struct Flight
{
  double residual = 0.;  // of the energy
  double gaping = 0.;    // largest share of particles
  double failed = 0.;    // share of particles at the end
  double frequency = 0.; // largest stable step times frequency
};

/** A block of failing metal whose particles fly apart at a rate of up to
    2e5/s, by another stretch and with other fluctuations for each @p seed;
    half-way all velocities turn round, by which no energy changes. */
Flight fly(const unsigned int seed, const double step_factor)
{
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(0.2);
  options.residual_strength = choose<ResidualStrength>("friction");
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, perturbed_cloud({{6e-3, 6e-3, 5e-3}}, 1e-3, 0.2),
      hardening_aluminum(), options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1., 1.);
  Mat rate = Mat::zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      rate.set(i, j, (i == j ? 1.2e5 : 0.) + 8e4 * number(random));
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = rate * (n.position[i] - vec(3e-3, 3e-3, 2.5e-3)) +
                    20. * vec(number(random), number(random), number(random));
  world.stepper.initialize();
  double before = 0.;
  Flight flight;
  const SpgParts &rooms = body.rooms();
  // Energy counts from where first bonds have failed: that all particles start
  // to move within one step costs 0.1 to 0.5 % by itself.
  constexpr int n_steps = 400, first = 40;
  for (int s = 0; s < n_steps; ++s)
  {
    if (s == n_steps / 2)
      for (Vec &v : n.velocity)
        v = -v;
    const double dt = world.advance(step_factor);
    // As a run does: velocities are those of whole steps, works go along half
    // ones.
    ExactSum kick;
    body.add_kick_energy(dt, kick);
    const double energy = world.total_energy() - kick.value();
    if (s <= first)
      before = energy;
    const double off = std::abs(energy - before) / before;
    if (!(off <= flight.residual)) // not-a-number stays
      flight.residual = off;
    if (s % 10 != 0)
      continue;
    std::size_t n_gaping = 0;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n_gaping += stiffness_share(rooms, i) < 1.;
    flight.gaping = std::max(flight.gaping, double(n_gaping) / n.n_owned);
    flight.frequency = std::max(
        flight.frequency, body.stable_step().dt * body.largest_frequency(40));
  }
  const auto &failed = rooms.failure.is_failed;
  flight.failed =
      double(std::count(failed.begin(), failed.end(), 1)) / n.n_owned;
  return flight;
}

std::vector<Check> spg_step_cracks()
{
  std::vector<Check> checks;
  for (const double factor : {0.9, 1.})
  {
    Flight worst, least{0., 1., 1., 0.};
    for (const unsigned int seed : {1, 2, 3, 4})
    {
      const Flight flight = fly(seed, factor);
      if (!(flight.residual <= worst.residual))
        worst.residual = flight.residual;
      worst.frequency = std::max(worst.frequency, flight.frequency);
      least.gaping = std::min(least.gaping, flight.gaping);
      least.failed = std::min(least.failed, flight.failed);
    }
    const std::string who = "step factor " + formatted("%g", factor);
    checks.push_back(
        {who + ": energy residual", 0., worst.residual, 1e-3, "1", "balance"});
    checks.push_back({who + ": stable step times largest frequency", 2.,
                      worst.frequency, 0., "1", "linear limit",
                      Check::Kind::at_most});
    checks.push_back({who + ": particles that failed", 0.5, least.failed, 0.,
                      "1", "the problem is one of cracks",
                      Check::Kind::at_least});
    checks.push_back({who + ": particles that gaped", 0.2, least.gaping, 0.,
                      "1", "the problem is one of gaping metal",
                      Check::Kind::at_least});
  }
  return checks;
}

const RegisterProblem
    cracks({"spg-step-cracks",
            "metal that cracks, gapes and closes: no step is too long", "quick",
            spg_step_cracks});
} // namespace
} // namespace sabot
