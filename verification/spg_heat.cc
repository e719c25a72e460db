// Conduction of heat among particles, in a slab and in a rod.
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double length = 1e-3, conductivity = 167.;

/** 6061-T6 that does not yield. */
std::shared_ptr<const Material> unyielding()
{
  return metal("al6061-t6",
               {"Johnson-Cook/Initial yield stress=1e12",
                "Johnson-Cook/Hardening modulus=0",
                "Johnson-Cook/Melt temperature=2000 K",
                "Johnson-Cook/Room temperature=300 K",
                "Johnson-Cook/Initial temperature=300 K",
                change("Johnson-Cook/Thermal conductivity", conductivity)});
}

struct Slab
{
  double error = 0., heat_change = 0.;
};

/** T = 300 + 100 cos(pi z/L) between insulated faces decays as
    exp(-kappa pi^2 t/L^2); largest error over 100 K. */
Slab slab(const ParticleCloud &cloud, const int steps)
{
  const double heat = aluminum().density *
                      metal_entry("al6061-t6", "Johnson-Cook/Specific heat");
  const double kappa = conductivity / heat, k = M_PI / length,
               end = 0.5 / (kappa * k * k);
  World world;
  SpgOptions options;
  options.conducts_heat = true;
  options.conduction_interval = 0.;
  world.bodies.push_back(
      std::make_unique<SpgBody>("slab", 0, cloud, unyielding(), options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  const NodalState &n = body.nodes();
  const auto profile = [&](const std::size_t i)
  { return 100. * std::cos(k * n.reference_position[i][2]); };
  double before = 0., after = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    body.rooms().points.state("temperature")[i] = 300. + profile(i);
    before += profile(i) * n.lumped_mass[i];
  }
  for (int i = 1; i <= steps; ++i)
    body.update_topology(i, end * i / steps);
  Slab result;
  double mass = 0.;
  for (const OutputField &field : body.output_mesh().cell_fields)
    if (field.name == "temperature")
      for (std::size_t i = 0; i < n.n_owned; ++i)
      {
        const double rise = field.values[i] - 300.;
        result.error = std::max(
            result.error, std::abs(rise - std::exp(-0.5) * profile(i)) / 100.);
        after += rise * n.lumped_mass[i];
        mass += n.lumped_mass[i];
      }
  result.heat_change = (after - before) / mass;
  return result;
}

/** Steps as h^2, so that the error in time, of first order, follows h^2. */
Slab box_slab(const int n)
{
  const double h = length / n;
  return slab(
      make_box_cloud({{0., 0., 0.5 * length}}, {{2 * h, 2 * h, length}}, h),
      n * n);
}

Slab rod(const int n)
{
  const double h = length / n;
  return slab(make_mesh_cloud(make_cylinder(0.3 * length, length, 2,
                                            {{0., 0., 0.5 * length}}, h)),
              n * n);
}

std::vector<Check> conduction()
{
  const Slab coarse = box_slab(8), middle = box_slab(16), fine = box_slab(32);
  const Slab coarse_rod = rod(8), fine_rod = rod(16);
  const char *const exact = "insulated slab, exp(-kappa pi^2 t/L^2)";
  return {
      {"error, 32 spacings", 0., fine.error, 2e-3, "1", exact},
      {"order in space, 8 to 16 spacings", 2.,
       std::log2(coarse.error / middle.error), 0.1, "1", "second order"},
      {"order in space, 16 to 32 spacings", 2.,
       std::log2(middle.error / fine.error), 0.1, "1", "second order"},
      {"mean temperature change", 0., fine.heat_change, 1e-9, "K",
       "no heat is lost"},
      {"round rod: error, 16 spacings", 0., fine_rod.error, 5e-3, "1", exact},
      {"round rod: order in space, 8 to 16 spacings", 2.,
       std::log2(coarse_rod.error / fine_rod.error), 0.3, "1", "second order"},
      {"round rod: mean temperature change", 0., fine_rod.heat_change, 1e-9,
       "K", "no heat is lost"}};
}

const RegisterProblem registered({"spg-heat-conduction",
                                  "insulated slab and rod of particles, "
                                  "implicit, second order",
                                  "quick", conduction});
} // namespace
} // namespace sabot
