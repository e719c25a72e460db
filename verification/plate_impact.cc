// Plane waves of plate impact: the Hugoniot, the elastic precursor.
#include "sabot/couplings/contact.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/driven.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
/** Two slabs in uniaxial strain, meeting at x = 0 with @p speed each. */
void add_slabs(World &world, const std::shared_ptr<const Material> &material,
               const int n, const double h, const double speed)
{
  for (const int side : {-1, 1})
  {
    FemOptions options;
    options.initial_velocity = {{-side * speed, 0., 0.}};
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        side < 0 ? "flyer" : "target", world.bodies.size(),
        make_bar(side < 0 ? -n * h : 0., n, h), material, options,
        hold_lateral));
  }
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

/** Stress along x, averaged over cells whose reference center lies between
    @p low and @p high. */
double axial_stress(const FemBody &body, const double start, const double h,
                    const double low, const double high)
{
  double sum = 0.;
  int n = 0;
  for (std::size_t e = 0; e < body.n_local_cells(); ++e)
  {
    const double x = start + (e + 0.5) * h;
    if (x < low || x > high)
      continue;
    sum += body.stress(0, e);
    ++n;
  }
  return sum / n;
}

/** Symmetric impact at 2 x 485 m/s of slabs that are nearly fluid. */
std::vector<Check> hugoniot()
{
  const double u = 485., h = 0.05e-3;
  const MieGruneisenParameters shock =
      mie_gruneisen_parameters("al6061-t6-eos");
  const double rho = shock.density, c0 = shock.sound_speed,
               slope = shock.shock_slope, gamma = shock.gruneisen;
  const int n = 200;
  World world;
  add_slabs(world,
            std::make_shared<HardeningPlasticity>(
                aluminum(), HardeningParameters{1e6, 0., 1.},
                std::make_shared<MieGruneisen>(shock)),
            n, h, u);
  const double shock_speed = c0 + slope * u, pressure = rho * shock_speed * u;
  // Arrival where the velocity passes half the jump, at two places.
  Crossing near{-0.5 * u}, far{-0.5 * u};
  near.old_value = far.old_value = -u;
  const FemBody &target = static_cast<const FemBody &>(*world.bodies[1]);
  while (world.stepper.time() < 0.8 * n * h / shock_speed)
  {
    world.advance(0.9);
    near.sample(world.stepper.time(), velocity_at(target, 3e-3, 0.5 * h));
    far.sample(world.stepper.time(), velocity_at(target, 7e-3, 0.5 * h));
  }
  const double got = -axial_stress(target, 0., h, 2e-3, 5e-3);
  // Shock speed relative to the material ahead of it.
  const double speed = 4e-3 / (far.time - near.time);
  const double energy =
      target.cell_state("specific internal energy")[int(4e-3 / h)];

  // Release: the free face of the target moves at -u + the integral of
  // dp/(rho c) along the isentrope from the shocked state, times two senses.
  while (world.stepper.time() < 1.25 * n * h / shock_speed)
    world.advance(0.9);
  const double face = velocity_at(target, n * h, 0.5 * h);
  const double J1 = 1. - u / shock_speed;
  double J = J1, internal = 0.5 * u * u, release = 0.;
  for (;;)
  {
    const double step = 1e-6, K = rho * c0 * c0;
    const auto p_at = [&](const double v, const double i)
    {
      const double eta = 1. - v, D = 1. - slope * eta;
      return (eta > 0. ? K * eta / (D * D) * (1. - 0.5 * gamma * eta)
                       : K * (1. / v - 1.)) +
             gamma * rho * i;
    };
    const double p = p_at(J, internal);
    if (p <= 0.)
      break;
    const double next = p_at(J + step, internal - p * step / rho);
    // du = sqrt(-dp dv)
    release += std::sqrt((p - next) * step / rho);
    internal -= p * step / rho;
    J += step;
  }
  return {
      {"Hugoniot stress", pressure, got, 0.02 * pressure, "Pa",
       "rho0 Us up, Us = c0 + s up"},
      {"shock speed", shock_speed, speed, 0.02 * shock_speed, "m/s",
       "Us = c0 + s up"},
      {"specific internal energy", 0.5 * u * u, energy, 0.02 * 0.5 * u * u,
       "J/kg", "Rankine-Hugoniot, up^2/2"},
      {"free-surface velocity after release", release, face, 0.02 * release,
       "m/s", "integral of sqrt(-dp dv) along the isentrope"},
  };
}

/** Symmetric impact at 2 x 60 m/s: elastic precursor and plastic wave. */
std::vector<Check> precursor()
{
  const double u = 60., h = 0.05e-3, Y = aluminum_yield_stress(),
               rho = aluminum().density;
  const int n = 200;
  World world;
  add_slabs(world, hardening_aluminum(Y, 0.), n, h, u);
  const double K = aluminum().bulk_modulus(), G = aluminum().shear_modulus();
  const double c_long = std::sqrt((K + 4. / 3. * G) / rho),
               c_bulk = std::sqrt(K / rho);
  const double limit = (K + 4. / 3. * G) * Y / (2. * G),
               jump = limit / (rho * c_long);
  Crossing near{-u + 0.5 * jump}, far{-u + 0.5 * jump};
  near.old_value = far.old_value = -u;
  const FemBody &target = static_cast<const FemBody &>(*world.bodies[1]);
  while (world.stepper.time() < 8e-3 / c_long)
  {
    world.advance(0.9);
    near.sample(world.stepper.time(), velocity_at(target, 2e-3, 0.5 * h));
    far.sample(world.stepper.time(), velocity_at(target, 6e-3, 0.5 * h));
  }
  // Between the fronts stands the elastic limit; behind, u.
  const double t = world.stepper.time();
  const double plateau =
      -axial_stress(target, 0., h, c_bulk * t + 0.3 * (c_long - c_bulk) * t,
                    c_long * t - 0.3 * (c_long - c_bulk) * t);
  const double final_stress = -axial_stress(target, 0., h, 1e-3, 4e-3);
  const double expected = limit + rho * c_bulk * (u - jump);
  return {
      {"speed of the elastic precursor", c_long, 4e-3 / (far.time - near.time),
       0.01 * c_long, "m/s", "sqrt((K + 4 G/3)/rho)"},
      {"Hugoniot elastic limit", limit, plateau, 0.02 * limit, "Pa",
       "(K + 4 G/3) Y/(2 G)"},
      {"stress behind the plastic wave", expected, final_stress,
       0.02 * expected, "Pa", "HEL + rho c_b (u - u_HEL), small strain"},
  };
}

const RegisterProblem first({"plate-impact-hugoniot",
                             "symmetric impact with Mie-Gruneisen, and release",
                             "quick", hugoniot});
const RegisterProblem second({"plate-impact-precursor",
                              "elastic precursor and plastic wave", "quick",
                              precursor});
} // namespace
} // namespace sabot
