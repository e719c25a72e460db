// One-dimensional waves in bars of hexahedra: elastic, meeting, bilinear.
#include "sabot/couplings/contact.h"
#include "sabot/materials/laws.h"
#include "verification/driven.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
/** A smooth push on the end of a slender free bar travels at sqrt(E/rho). */
std::vector<Check> bar_wave()
{
  const double rho = aluminum().density, E = aluminum().young_modulus;
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
  world.stepper.initialize();
  Crossing near{0.5 * speed}, far{0.5 * speed};
  const auto &bar = static_cast<const FemBody &>(*world.bodies[0]);
  while (world.stepper.time() < 38e-6)
  {
    world.advance(0.9);
    near.sample(world.stepper.time(), velocity_at(bar, 30e-3, 0.5 * h));
    far.sample(world.stepper.time(), velocity_at(bar, 130e-3, 0.5 * h));
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
  const double rho = aluminum().density, E = aluminum().young_modulus;
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
  world.stepper.initialize();
  const double energy = world.total_energy();
  const auto &bar = static_cast<const FemBody &>(*world.bodies[1]);
  double stress = 0.;
  int samples = 0;
  // The bars part when their faces do.
  double parted = std::nan("");
  while (world.stepper.time() < 3. * length / c)
  {
    world.advance(0.9);
    const double t = world.stepper.time();
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
          {"velocity of the struck bar", v, bar.measure().velocity[0], 0.01 * v,
           "m/s", "equal bars exchange velocities"},
          {"velocity of the striker", 0.,
           world.bodies[0]->measure().velocity[0], 0.01 * v, "m/s",
           "equal bars exchange velocities"},
          {"energy change", 0., world.total_energy() / energy - 1., 1e-3, "1",
           "energy balance"}};
}

/** Two equal bars of a bilinear metal meet at 2 x v: an elastic front of the
    yield stress and a plastic one behind it (Karman, Taylor and Rakhmatulin).
    Strains are of 1 %; nu = 0.3 with free sides, slender. */
std::vector<Check> bilinear()
{
  const double rho = aluminum().density, E = aluminum().young_modulus;
  const double h = 0.5e-3, v = 20., Y = 100e6, Et = E / 9.;
  const double H = E * Et / (E - Et), c = std::sqrt(E / rho), c_p = c / 3.;
  const int n = 240;
  const double length = n * h;
  ElasticConstants constants = aluminum();
  constants.poisson_ratio = 0.3;
  const auto bilinear = std::make_shared<HardeningPlasticity>(
      constants, HardeningParameters{Y, H, 1.});
  World world;
  for (const int side : {-1, 1})
  {
    FemOptions options;
    options.initial_velocity = {{-side * v, 0., 0.}};
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        side < 0 ? "striker" : "bar", world.bodies.size(),
        make_bar(side < 0 ? -length : 0., n, h), bilinear, options,
        [](NodalState &, const double) {}));
  }
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  const auto &bar = static_cast<const FemBody &>(*world.bodies[1]);
  // What the elastic front leaves, and the plastic one.
  const double jump = Y / (rho * c), stress = Y + rho * c_p * (v - jump),
               strain = (stress - Y) / H;
  Crossing elastic_near{-v + 0.5 * jump}, elastic_far{-v + 0.5 * jump},
      plastic_near{0.5 * (jump - v)}, plastic_far{0.5 * (jump - v)};
  for (Crossing *x : {&elastic_near, &elastic_far, &plastic_near, &plastic_far})
    x->old_value = -v;
  const double end = 0.95 * length / c;
  while (world.stepper.time() < end)
  {
    world.advance(0.9);
    const double t = world.stepper.time();
    elastic_near.sample(t, velocity_at(bar, 40e-3, 0.5 * h));
    elastic_far.sample(t, velocity_at(bar, 100e-3, 0.5 * h));
    plastic_near.sample(t, velocity_at(bar, 10e-3, 0.5 * h));
    plastic_far.sample(t, velocity_at(bar, 30e-3, 0.5 * h));
  }
  const std::vector<double> eps = bar.cell_state("effective plastic strain");
  double behind = 0., between = 0., flow = 0.;
  const int first = std::lround(8e-3 / h), last = std::lround(24e-3 / h),
            from = std::lround(60e-3 / h), to = std::lround(90e-3 / h);
  for (int e = first; e < last; ++e)
  {
    behind -= bar.stress(0, e) / (last - first);
    flow += eps[e] / (last - first);
  }
  for (int e = from; e < to; ++e)
    between -= bar.stress(0, e) / (to - from);
  const std::string source = "one-dimensional bilinear bar";
  return {{"speed of the elastic front", c,
           60e-3 / (elastic_far.time - elastic_near.time), 0.01 * c, "m/s",
           "sqrt(E/rho)"},
          {"speed of the plastic front", c_p,
           20e-3 / (plastic_far.time - plastic_near.time), 0.03 * c_p, "m/s",
           "sqrt(Et/rho)"},
          {"stress between the fronts", Y, between, 0.02 * Y, "Pa", source},
          {"stress behind both", stress, behind, 0.02 * stress, "Pa",
           "Y + rho c_p (v - Y/(rho c))"},
          {"plastic strain behind both", strain, flow, 0.03 * strain, "1",
           "(stress - Y)/H"},
          {"energy change", 0., world.total_energy() / energy - 1., 2e-3, "1",
           "energy balance"}};
}

const RegisterProblem wave({"bar-wave", "slender elastic bar, driven end",
                            "quick", bar_wave});
const RegisterProblem impact({"saint-venant-impact",
                              "two equal elastic bars meet", "quick",
                              saint_venant});
const RegisterProblem plastic({"saint-venant-bilinear",
                               "two equal bars of a bilinear metal meet",
                               "quick", bilinear});
} // namespace
} // namespace sabot
