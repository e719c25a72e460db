// One driven cell: objective rates in simple shear, Johnson-Cook in tension.
#include "sabot/materials/laws.h"
#include "verification/driven.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
/** A cell in simple shear, x = X + gamma Y, all nodes driven. */
double sheared_stress(const FemOptions::ObjectiveRate rate, const double gamma,
                      double &normal)
{
  const ElasticConstants &c = aluminum();
  World world;
  FemOptions options;
  options.objective_rate = rate;
  const double h = 1e-3, speed = 100.; // shear rate speed/h
  world.bodies.push_back(std::make_unique<DrivenFemBody>(
      "cell", 0, make_bar(0., 1, h), elastic(), options,
      [=](NodalState &n, const double)
      {
        for (std::size_t i = 0; i < n.size(); ++i)
          n.velocity[i] = vec(speed * n.reference_position[i][1] / h, 0., 0.);
      }));
  world.distribute();
  world.stepper.initialize();
  const int steps = 4000;
  for (int i = 0; i < steps; ++i)
    world.stepper.advance(gamma * h / speed / steps);
  const auto &cell = static_cast<const FemBody &>(*world.bodies[0]);
  normal = cell.stress(0, 0) / c.shear_modulus();
  return cell.stress(3, 0) / c.shear_modulus();
}

std::vector<Check> simple_shear()
{
  std::vector<Check> checks;
  for (const double gamma : {1., 3., 6.})
  {
    const std::string at = ", gamma " + std::to_string(int(gamma));
    double normal;
    const double jaumann =
        sheared_stress(FemOptions::ObjectiveRate::jaumann, gamma, normal);
    const std::string source = "Dienes 1979";
    checks.push_back({"Jaumann, shear stress / G" + at, std::sin(gamma),
                      jaumann, 2e-3, "1", source});
    checks.push_back({"Jaumann, normal stress / G" + at, 1. - std::cos(gamma),
                      normal, 2e-3, "1", source});
    // R turns by beta, tan(beta) = gamma/2.
    const double beta = std::atan(0.5 * gamma), cos_2 = std::cos(2. * beta),
                 sin_2 = std::sin(2. * beta),
                 log_cos = std::log(std::cos(beta));
    const double xy = 4. * beta * cos_2 - 4. * sin_2 * log_cos -
                      2. * cos_2 * std::tan(beta),
                 xx = 4. * (cos_2 * log_cos + beta * sin_2 -
                            std::sin(beta) * std::sin(beta));
    const double naghdi =
        sheared_stress(FemOptions::ObjectiveRate::green_naghdi, gamma, normal);
    checks.push_back(
        {"Green-Naghdi, shear stress / G" + at, xy, naghdi, 2e-3, "1", source});
    checks.push_back({"Green-Naghdi, normal stress / G" + at, xx, normal, 2e-3,
                      "1", source});
  }
  return checks;
}

/** Uniaxial stress at a constant true strain rate: one small cell, the ends
    driven, the sides free. */
std::vector<Check> uniaxial_johnson_cook()
{
  const JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  const double room = p.room_temperature;
  const ElasticConstants &c = aluminum();
  std::vector<Check> checks;
  for (const double rate : {1e3, 1e4})
  {
    World world;
    const double h = 10e-6;
    FemOptions options;
    // Viscosity is a stress of its own here.
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        "cell", 0, make_bar(0., 1, h), metal("al6061-t6"), options,
        [=](NodalState &n, const double)
        {
          // Lateral motion starts with the elastic contraction and is
          // damped, so that the cell does not ring.
          for (std::size_t i = 0; i < n.size(); ++i)
            n.velocity[i] =
                vec(rate * n.position[i][0], 0.999 * n.velocity[i][1],
                    0.999 * n.velocity[i][2]);
        }));
    world.distribute();
    world.stepper.initialize();
    double end = 0.2;
    while (world.stepper.time() < end / rate)
      world.advance(0.5);
    const auto &cell = static_cast<const FemBody &>(*world.bodies[0]);
    const double strain = rate * world.stepper.time();
    // Reference: sigma = E (strain - eps), explicit in eps with the flow rule
    // inverted by bisection in each of many small steps.
    double sigma = 0., eps = 0., T = room;
    const int n = 200000;
    const double d_strain = strain / n, dt = d_strain / rate;
    for (int i = 0; i < n; ++i)
    {
      const double trial = sigma + c.young_modulus * d_strain;
      const double thermal =
          1. - std::pow((T - room) / (p.melt_temperature - room), p.m);
      const auto flow = [&](const double d)
      {
        return (p.A + p.B * std::pow(eps + d, p.n)) *
               (1. + p.C * std::log(std::max(1., d / dt))) * thermal;
      };
      sigma = trial;
      if (trial > flow(0.))
      {
        double low = 0., high = d_strain;
        for (int k = 0; k < 40; ++k)
        {
          const double d = 0.5 * (low + high);
          (trial - c.young_modulus * d > flow(d) ? low : high) = d;
        }
        sigma = trial - c.young_modulus * low;
        eps += low;
        T += p.taylor_quinney * sigma * low / (c.density * p.specific_heat);
      }
    }
    const std::string at = ", rate " + std::to_string(int(rate)) + " 1/s";
    const std::string source = "integrated law in uniaxial stress";
    checks.push_back({"axial stress" + at, sigma, cell.stress(0, 0),
                      2e-3 * sigma, "Pa", source});
    checks.push_back({"lateral stress" + at, 0., cell.stress(1, 0),
                      2e-3 * sigma, "Pa", source});
    checks.push_back({"effective plastic strain" + at, eps,
                      cell.cell_state("effective plastic strain")[0],
                      2e-3 * eps, "1", source});
    checks.push_back({"temperature rise" + at, T - room,
                      cell.cell_state("temperature")[0] - room,
                      5e-3 * (T - room), "K", source});
  }
  return checks;
}

const RegisterProblem shear({"simple-shear",
                             "hypoelastic cell, Jaumann and Green-Naghdi",
                             "quick", simple_shear});
const RegisterProblem uniaxial({"johnson-cook-uniaxial",
                                "one cell in uniaxial stress at a given rate",
                                "quick", uniaxial_johnson_cook});
} // namespace
} // namespace sabot
