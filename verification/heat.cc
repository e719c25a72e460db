// Heat in hexahedra: conduction in a slab, thermal expansion.
#include "verification/driven.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
/** 6061-T6 that does not yield, and its conductivity [W/m/K]. */
constexpr double conductivity = 167.;

std::shared_ptr<const Material> unyielding(const double expansion)
{
  return metal("al6061-t6",
               {"Johnson-Cook/Initial yield stress=1e12",
                "Johnson-Cook/Hardening modulus=0",
                "Johnson-Cook/Melt temperature=2000 K",
                "Johnson-Cook/Room temperature=300 K",
                "Johnson-Cook/Initial temperature=300 K",
                change("Johnson-Cook/Thermal conductivity", conductivity),
                change("Johnson-Cook/Thermal expansion", expansion)});
}

struct Slab
{
  double error, heat_change, iterations;
};

/** T = 300 + 100 cos(pi x/L) between insulated faces decays as
    exp(-kappa pi^2 t/L^2); largest error of cell means, over 100 K. */
Slab slab(const int n)
{
  const double heat = aluminum().density *
                      metal_entry("al6061-t6", "Johnson-Cook/Specific heat");
  const double length = 1e-3, kappa = conductivity / heat, k = M_PI / length,
               end = 0.5 / (kappa * k * k);
  World world;
  FemOptions options;
  options.conducts_heat = true;
  options.conduction_interval = 0.;
  world.bodies.push_back(std::make_unique<FemBody>(
      "slab", 0, make_bar(0., n, length / n), unyielding(0.), options));
  world.distribute();
  auto &body = static_cast<FemBody &>(*world.bodies[0]);
  const double h = length / n;
  const auto mean = [&](const int e)
  { return (std::sin(k * (e + 1) * h) - std::sin(k * e * h)) / (k * h); };
  std::vector<double> start;
  for (int e = 0; e < n; ++e)
    start.push_back(100. * mean(e));
  body.shift_state("temperature", start);
  // Steps as h^2, so that the error in time, of first order, follows h^2.
  const int steps = n * n;
  for (int i = 1; i <= steps; ++i)
    body.update_topology(i, end * i / steps);
  const std::vector<double> T = body.cell_state("temperature");
  Slab result{0., 0., 0.};
  for (int e = 0; e < n; ++e)
  {
    result.error = std::max(
        result.error,
        std::abs(T[e] - 300. - 100. * std::exp(-0.5) * mean(e)) / 100.);
    result.heat_change += (T[e] - 300.) / n;
  }
  return result;
}

std::vector<Check> conduction()
{
  const Slab coarse = slab(8), middle = slab(16), fine = slab(32),
             finest = slab(64);
  return {{"error, 64 cells", 0., finest.error, 1e-3, "1",
           "insulated slab, exp(-kappa pi^2 t/L^2)"},
          {"order in space, 8 to 16 cells", 2.,
           std::log2(coarse.error / middle.error), 0.1, "1", "second order"},
          {"order in space, 16 to 32 cells", 2.,
           std::log2(middle.error / fine.error), 0.1, "1", "second order"},
          {"order in space, 32 to 64 cells", 2.,
           std::log2(fine.error / finest.error), 0.1, "1", "second order"},
          {"mean temperature change", 0., finest.heat_change, 1e-9, "K",
           "no heat is lost"}};
}

/** A cell heated by 100 K: free, it grows by alpha dT; held, its pressure is
    3 K alpha dT. */
std::vector<Check> expansion()
{
  const double alpha = 23e-6, rise = 100.;
  std::vector<Check> checks;
  for (const bool held : {true, false})
  {
    World world;
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        "cell", 0, make_bar(0., 1, 1e-3), unyielding(alpha), FemOptions(),
        [held](NodalState &n, const double)
        {
          // Damped towards equilibrium when free.
          for (Vec &v : n.velocity)
            v = held ? Vec{} : 0.98 * v;
        }));
    world.distribute();
    auto &cell = static_cast<FemBody &>(*world.bodies[0]);
    cell.shift_state("temperature", {rise});
    world.stepper.initialize();
    for (int i = 0; i < 2000; ++i)
      world.advance(0.5);
    const double pressure = 3. * aluminum().bulk_modulus() * alpha * rise;
    if (held)
      checks.push_back({"pressure of a held cell", pressure, -cell.stress(0, 0),
                        1e-9 * pressure, "Pa", "3 K alpha dT"});
    else
    {
      const double size = cell.measure().high[0] - cell.measure().low[0];
      checks.push_back({"strain of a free cell", alpha * rise,
                        std::log(size / 1e-3), 1e-6 * alpha * rise, "1",
                        "alpha dT"});
    }
  }
  return checks;
}

const RegisterProblem first({"heat-conduction",
                             "insulated slab, implicit, second order", "quick",
                             conduction});
const RegisterProblem second({"thermal-expansion", "held and free heated cells",
                              "quick", expansion});
} // namespace
} // namespace sabot
