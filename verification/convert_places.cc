// Cells that turn into particles in odd places: one alone, beside a clamp, at a
// plane of symmetry, in two bodies at once, beside a tie, in a body that falls.
#include "verification/balance.h"
#include "verification/convert.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3;

/** Two blocks of metal that fly and spin apart from each other, in which cells
    turn in three bites. */
struct Flight
{
  double momentum = 0., angular = 0., balance = 0., particles = 0.;
  bool finite = true;
};

Flight fly(const std::function<bool(const int bite, const Place &)> &bites,
           const unsigned int held, const bool clamped,
           const unsigned int ratio)
{
  World world;
  ConvertingOptions options;
  if (ratio > 1)
    options.spacing = spacing / ratio;
  if (clamped)
    options.fem.clamped_boundary_ids = {held};
  else if (held < 6)
    options.fem.symmetry_boundary_ids = {held};
  std::vector<std::shared_ptr<PlaceTest>> where;
  for (const double at : {0., 9e-3})
  {
    options.name = at == 0. ? "left" : "right";
    where.push_back(add_converting(
        world, block_mesh({{5e-3, 4e-3, 4e-3}}, {{at, 0.5e-3, 0.}}, spacing),
        metal("al6061-t6", {"Johnson-Cook/Damage=false"}), options));
  }
  join_converting(world);
  world.distribute();
  for (std::size_t b = 0; b < 4; b += 2)
  {
    NodalState &n = world.bodies[b]->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      // Spins and is squeezed: waves and flow in all directions.
      const Vec r = n.position[i] - vec(b == 0 ? 0. : 9e-3, 0.5e-3, 0.);
      n.velocity[i] = vec(20. - 2e4 * r[1] - 3e4 * r[0],
                          2e4 * r[0] + 1e4 * r[1], 1e4 * r[2] + 10.);
    }
  }
  world.stepper.initialize();
  Flight worst;
  EnergyWatch watch(world);
  const auto mass_and_size = [&]
  { return std::sqrt(2. * 0.5e-3 * world.ledger().kinetic.value()); };
  for (int step = 0; step < 120; ++step)
  {
    const int bite = step / 30;
    for (const auto &test : where)
      *test = [&, bite](const Place &x) { return bites(bite, x); };
    world.stepper.advance(0.5 * world.stepper.propose(false).dt);
    const auto before = world.momenta();
    world.stepper.update();
    const auto after = world.momenta();
    for (int d = 0; d < 3; ++d)
    {
      worst.momentum = std::max(worst.momentum, std::abs(after[d] - before[d]) /
                                                    mass_and_size());
      worst.angular =
          std::max(worst.angular, std::abs(after[3 + d] - before[3 + d]) /
                                      (5e-3 * mass_and_size()));
    }
    watch.look();
  }
  worst.balance = watch.residual();
  worst.finite = is_finite(world);
  worst.particles =
      world.bodies[1]->nodes().n_owned + world.bodies[3]->nodes().n_owned;
  return worst;
}

std::vector<Check> places()
{
  const struct
  {
    const char *name;
    std::function<bool(int, const Place &)> bites;
    unsigned int held;
    bool clamped;
  } cases[] = {
      {"one cell",
       [](int bite, const Place &x)
       {
         return bite > 0 && std::abs(x[0]) < 0.1e-3 &&
                std::abs(x[2] - 0.5e-3) < 0.1e-3 &&
                std::abs(x[1] - 1e-3) < 0.6e-3;
       },
       9, false},
      {"every other cell, then the rest",
       [](int bite, const Place &x)
       {
         const int sum = int(std::floor(1e3 * x[0] + 20.)) +
                         int(std::floor(1e3 * x[1] + 20.)) +
                         int(std::floor(1e3 * x[2] + 20.));
         return bite == 1 ? sum % 2 == 0 : bite > 1;
       },
       9, false},
      {"all at once", [](int bite, const Place &) { return bite > 0; }, 9,
       false},
      {"from a clamp on",
       [](int bite, const Place &x) { return x[1] < -1.5e-3 + 1.1e-3 * bite; },
       2, true},
      {"towards a clamp",
       [](int bite, const Place &x) { return x[1] > 2.5e-3 - 1.4e-3 * bite; },
       2, true},
      {"along a plane of symmetry",
       [](int bite, const Place &x) { return x[1] < -1.5e-3 + 1.1e-3 * bite; },
       2, false},
  };
  std::vector<Check> checks;
  for (const unsigned int ratio : {1, 2, 3})
    for (const auto &c : cases)
    {
      const Flight none = fly([](int, const Place &) { return false; }, c.held,
                              c.clamped, ratio);
      const Flight f = fly(c.bites, c.held, c.clamped, ratio);
      const std::string what =
          std::string(c.name) +
          (ratio > 1 ? ", split by " + std::to_string(ratio) : "") + ": ";
      checks.push_back({what + "jumps of momentum", 0., f.momentum, 1e-12,
                        "of sqrt(2 m E)", "exact", Check::Kind::at_most});
      checks.push_back({what + "jumps of angular momentum", 0., f.angular,
                        1e-12, "of it times a length", "exact",
                        Check::Kind::at_most});
      checks.push_back({what + "particles at the end", 8., f.particles, 0., "1",
                        "", Check::Kind::at_least});
      // The start is a shock, of which the balance shows the coarse steps.
      checks.push_back({what + "energy residual", none.balance, f.balance, 2e-4,
                        "1", "without conversion", Check::Kind::at_most});
      checks.push_back(
          {what + "all are numbers", 1., double(f.finite), 0., "1", ""});
    }
  return checks;
}

const RegisterProblem registered(
    {"convert-places",
     "Cells that turn into particles one by one, all at once, at clamps and "
     "planes, in two bodies.",
     "quick", places});
} // namespace
} // namespace sabot
