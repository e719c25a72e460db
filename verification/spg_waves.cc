// Waves and vibrations of particles: bar, cantilever, pulse, step limit.
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
SpgOptions inviscid()
{
  SpgOptions o;
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  return o;
}

SpgBody &add_block(World &world, const std::array<double, 3> &size,
                   const double spacing, std::shared_ptr<const Material> metal)
{
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0, make_box_cloud({{0, 0, 0}}, size, spacing), metal, inviscid()));
  world.distribute();
  return static_cast<SpgBody &>(*world.bodies[0]);
}

/** Speed of longitudinal waves in a slender bar [m/s]. */
double bar_speed()
{
  return std::sqrt(aluminum().young_modulus / aluminum().density);
}

/** Frequency [1/s] from the @p n-th zero crossing of sum m v . shape, when the
    body starts at rest in shape with the velocity shape. */
template <typename ModeShape>
double frequency(World &world, const ModeShape &shape, const int n_crossings,
                 const double factor)
{
  NodalState &n = world.bodies[0]->nodes();
  std::vector<Vec> form(n.n_owned);
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    form[i] = shape(n.reference_position[i]);
    n.velocity[i] = n.inertia[i] < 1e3 * n.lumped_mass[i] ? form[i] : Vec{};
  }
  world.stepper.initialize();
  const auto amplitude = [&]
  {
    double sum = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      sum += n.lumped_mass[i] * dot(n.velocity[i], form[i]);
    return sum;
  };
  double last = amplitude(), time = 0., first = 0.;
  for (int crossings = 0;;)
  {
    const double dt = world.advance(factor), now = amplitude();
    if (now * last < 0.)
    {
      const double at = time + dt * last / (last - now);
      if (++crossings == 1)
        first = at;
      if (crossings == n_crossings)
        return 0.5 * (n_crossings - 1) / (at - first);
    }
    time += dt;
    last = now;
  }
}

std::vector<Check> spg_bar()
{
  // nu = 0: first longitudinal frequency c / (2 L) of the free bar.
  const double L = 20e-3, exact = bar_speed() / (2. * L);
  std::vector<Check> checks;
  double error[3];
  int k = 0;
  for (const double h : {2e-3, 1e-3, 0.5e-3})
  {
    World world;
    add_block(world, {{L, 2e-3, 2e-3}}, h, elastic(0.));
    const double f = frequency(
        world,
        [&](const Vec X) { return vec(std::sin(M_PI * X[0] / L), 0., 0.); }, 5,
        0.4);
    error[k++] = std::abs(f / exact - 1.);
    char name[64];
    std::snprintf(name, sizeof(name), "bar, %g mm: frequency", 1e3 * h);
    checks.push_back({name, exact, f, h > 1e-3 ? 0.02 * exact : 5e-3 * exact,
                      "1/s", "c / (2 L)"});
  }
  checks.push_back({"bar: order from the two finest", 1.8,
                    std::log2(error[1] / error[2]), 0., "1", "second order",
                    Check::Kind::at_least});
  return checks;
}

/** First frequency [1/s] of a clamped-free Timoshenko beam of square section
    (Huang 1961, J. Appl. Mech. 28:579). */
double timoshenko_cantilever(const double L, const double H, const double E,
                             const double rho, const double nu)
{
  const double area = H * H, I = area * area / 12., G = E / (2. * (1. + nu)),
               shear = 5. / 6.;
  const double r2 = I / (area * L * L), s2 = E * I / (shear * area * G * L * L);
  const auto determinant = [&](const double b)
  {
    const double root = std::sqrt((r2 - s2) * (r2 - s2) + 4. / (b * b));
    const double alpha = std::sqrt(0.5 * (root - r2 - s2)),
                 beta = std::sqrt(0.5 * (root + r2 + s2));
    return 2. +
           (b * b * (r2 - s2) * (r2 - s2) + 2.) * std::cosh(b * alpha) *
               std::cos(b * beta) -
           b * (r2 + s2) / std::sqrt(1. - b * b * r2 * s2) *
               std::sinh(b * alpha) * std::sin(b * beta);
  };
  double low = 1., high = 3.6; // slender: 3.516
  for (int i = 0; i < 100; ++i)
  {
    const double middle = 0.5 * (low + high);
    (determinant(middle) * determinant(low) > 0. ? low : high) = middle;
  }
  return low * std::sqrt(E * I / (rho * area)) / (L * L) / (2. * M_PI);
}

std::vector<Check> spg_cantilever()
{
  // Square beam L = 6 H, foot held by a large inertia.
  const double H = 2e-3, L = 12e-3, E = aluminum().young_modulus,
               rho = aluminum().density, nu = 0.;
  const double exact = timoshenko_cantilever(L, H, E, rho, nu),
               beta = 1.8751040687 / L;
  std::vector<Check> checks;
  double f[3];
  int k = 0;
  for (const double h : {1e-3, 0.5e-3, 0.25e-3})
  {
    World world;
    SpgBody &body = add_block(world, {{L, H, H}}, h, elastic(nu));
    NodalState &n = body.nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (n.reference_position[i][0] < -0.5 * L + 1e-9)
        n.inertia[i] *= 1e9;
    f[k++] = frequency(
        world,
        [&](const Vec X)
        {
          const double s = beta * (X[0] + 0.5 * L);
          return vec(0., 0.,
                     std::cosh(s) - std::cos(s) -
                         0.7340955 * (std::sinh(s) - std::sin(s)));
        },
        3, 0.9);
  }
  checks.push_back({"cantilever, 1 mm: frequency", 0., f[0], 0., "1/s", "",
                    Check::Kind::reported});
  checks.push_back({"cantilever, 0.5 mm: frequency", 0., f[1], 0., "1/s", "",
                    Check::Kind::reported});
  checks.push_back({"cantilever, 0.25 mm: frequency", 0., f[2], 0., "1/s", "",
                    Check::Kind::reported});
  checks.push_back({"cantilever: extrapolated by second order", exact,
                    f[2] - (f[1] - f[2]) / 3., 0.01 * exact, "1/s",
                    "Timoshenko beam (Huang 1961)"});
  checks.push_back({"cantilever: order of the error, two finest", 1.8,
                    std::log2((f[1] - exact) / (f[2] - exact)), 0., "1",
                    "second order", Check::Kind::at_least});
  return checks;
}

std::vector<Check> spg_wave()
{
  // The left half moves at 2 m/s: waves of 1 m/s leave to both sides.
  const double L = 80e-3, h = 0.5e-3, c = bar_speed(),
               impedance = aluminum().density * c;
  World world;
  SpgBody &body = add_block(world, {{L, 2. * h, 2. * h}}, h, elastic(0.));
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = vec(n.reference_position[i][0] < -1e-9  ? 2.
                        : n.reference_position[i][0] > 1e-9 ? 0.
                                                            : 1.,
                        0., 0.);
  world.stepper.initialize();
  const double station = 20e-3;
  double arrival = 0., plateau = 0., stress = 0.;
  int samples = 0;
  const auto mean = [&](const auto &value)
  {
    double sum = 0., weight = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (std::abs(n.reference_position[i][0] - station) < 1e-9)
      {
        sum += n.lumped_mass[i] * value(i);
        weight += n.lumped_mass[i];
      }
    return sum / weight;
  };
  while (world.stepper.time() < 6e-6)
  {
    const double dt = world.advance(0.8);
    const double v =
        mean([&](const std::size_t i) { return n.velocity[i][0]; });
    if (arrival == 0. && v > 0.5)
      arrival = world.stepper.time() - 0.5 * dt;
    if (world.stepper.time() > 5e-6)
    {
      plateau += v;
      stress += mean([&](const std::size_t i) { return body.stress(0, i); });
      ++samples;
    }
  }
  return {{"arrival at 20 mm", station / c, arrival, h / c, "s",
           "one-dimensional wave"},
          {"particle velocity behind the front", 1., plateau / samples, 0.02,
           "m/s", "one-dimensional wave"},
          {"stress behind the front", -impedance, stress / samples,
           0.02 * impedance, "Pa", "rho c v"}};
}

std::vector<Check> spg_step_limit()
{
  // Steps at 0.99 of the linear limit keep the energy, 1.05 do not. Small
  // amplitudes: the linear limit is asked for.
  std::vector<Check> checks;
  for (const double factor : {0.99, 1.05})
  {
    World world;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, perturbed_cloud({{3e-3, 3e-3, 3e-3}}, 1e-3, 0.2), elastic(),
        inviscid()));
    world.distribute();
    auto &body = static_cast<SpgBody &>(*world.bodies[0]);
    shake(body, 1e-3);
    const double dt = factor * 2. / body.largest_frequency(150);
    world.stepper.initialize();
    // The quantity that central difference keeps: v(n+1/2) . v(n-1/2) in the
    // kinetic part; the plain sum oscillates. Compared as means of windows.
    double first = 0., last = 0.;
    const int n_steps = factor < 1. ? 100000 : 2000, window = n_steps / 4;
    bool blew_up = false;
    try
    {
      for (int s = 0; s < n_steps && !blew_up; ++s)
      {
        world.stepper.advance(dt);
        world.stepper.update();
        if (s < window)
          first += world.total_energy() / window;
        if (s >= n_steps - window)
          last += world.total_energy() / window;
        blew_up =
            factor > 1. && world.total_energy() > 100. * first && s > window;
      }
    }
    catch (const PhysicsError &)
    {
      blew_up = true;
    }
    if (factor < 1.)
      checks.push_back({"0.99 of the limit, 1e5 steps: energy, last over first "
                        "quarter",
                        1., last / first, 1e-3, "1", "no drift"});
    else
      checks.push_back({"1.05 of the limit: blows up", 1., double(blew_up), 0.,
                        "1", "unstable"});
  }
  return checks;
}

const RegisterProblem bar({"spg-bar", "longitudinal vibration, three spacings",
                           "quick", spg_bar}),
    beam({"spg-cantilever", "bending vibration, three spacings", "long",
          spg_cantilever}),
    wave({"spg-wave", "elastic wave: arrival, amplitude, stress", "quick",
          spg_wave}),
    limit({"spg-step-limit", "steps just below and above the stable one",
           "long", spg_step_limit});
} // namespace
} // namespace sabot
