// Materials at their limits: melt, moduli far apart, cells of extreme shape.
#include "sabot/couplings/tie.h"
#include "sabot/kernels/stress_update.h"
#include "sabot/materials/laws.h"
#include "verification/balance.h"
#include "verification/driven.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double h = 1e-3;

SpgOptions inviscid_particles()
{
  SpgOptions o;
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  return o;
}

FemOptions inviscid_cells()
{
  FemOptions o;
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  return o;
}

/** A block of either kind with Johnson-Cook starting at @p temperature, sheared
    by all of its nodes' motion x = X + gamma Y. */
template <typename Add>
void shear_hot(std::vector<Check> &checks, const std::string &who,
               const double temperature, const double rate, const double gamma,
               const Add &add)
{
  const JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  World world;
  add(world, metal("al6061-t6",
                   {change("Johnson-Cook/Initial temperature", temperature)}));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  const int steps = 4000;
  const double dt = gamma / rate / steps;
  double hottest = 0., strongest = 0.;
  bool finite = true;
  for (int s = 1; s <= steps; ++s)
  {
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      const Vec X = n.reference_position[i];
      n.velocity[i] = vec(rate * X[1], 0., 0.);
      n.position[i] = X + vec(gamma * s / steps * X[1], 0., 0.);
    }
    body.update_ghosts();
    body.compute_forces(s * dt, dt);
    body.update_topology(s, s * dt);
  }
  const auto add_point = [&](const auto &stress)
  {
    double t[6];
    for (int c = 0; c < 6; ++c)
    {
      t[c] = stress(c);
      finite = finite && std::isfinite(t[c]);
    }
    strongest = std::max(strongest, von_mises(t));
  };
  if (const auto *fem = dynamic_cast<const FemBody *>(&body))
    for (std::size_t e = 0; e < fem->n_local_cells(); ++e)
      add_point([&](const int c) { return fem->stress(c, e); });
  if (const auto *spg = dynamic_cast<const SpgBody *>(&body))
    for (std::size_t i = 0; i < n.n_owned; ++i)
      add_point([&](const int c) { return spg->stress(c, i); });
  hottest = measure(body, "temperature max");
  char at[64];
  std::snprintf(at, sizeof(at), "from %g K: ", temperature);
  checks.push_back(
      {who + at + "numbers", 1., double(finite), 0., "1", "no not-a-number"});
  if (temperature >= p.melt_temperature)
  {
    checks.push_back({who + at + "von Mises stress over A", 0., strongest / p.A,
                      1e-9, "1", "no strength at melt"});
    checks.push_back({who + at + "temperature", temperature, hottest, 1e-6, "K",
                      "nothing heats"});
  }
  else
  {
    checks.push_back({who + at + "temperature at most", p.melt_temperature,
                      hottest, 1., "K", "heating stops at melt",
                      Check::Kind::at_most});
    checks.push_back({who + at + "temperature at least", 700., hottest, 0., "K",
                      "so that it gets near melt", Check::Kind::at_least});
    checks.push_back({who + at + "von Mises stress over A", 0.4,
                      strongest / p.A, 0., "1", "it has softened",
                      Check::Kind::at_most});
  }
}

std::vector<Check> melt()
{
  std::vector<Check> checks;
  const auto cell = [](World &world, std::shared_ptr<const Material> law)
  {
    world.bodies.push_back(std::make_unique<FemBody>(
        "cell", 0, make_bar(0., 1, h), law, inviscid_cells()));
  };
  const auto cloud = [](World &world, std::shared_ptr<const Material> law)
  {
    world.bodies.push_back(std::make_unique<SpgBody>(
        "cloud", 0, perturbed_cloud({{4e-3, 4e-3, 4e-3}}, h, 0.1), law,
        inviscid_particles()));
  };
  for (const double temperature : {925., 5000.})
  {
    shear_hot(checks, "cell ", temperature, 1e5, 1., cell);
    shear_hot(checks, "particles ", temperature, 1e5, 1., cloud);
  }
  shear_hot(checks, "cell ", 294., 1e5, 30., cell);
  // Particles that were neighbors must stay in each other's kernels.
  shear_hot(checks, "particles ", 700., 1e5, 5., cloud);
  return checks;
}

/** A stiff bar pushes a soft one, 10^6 between the moduli, across a tie, like a
    rigid mass. */
void stiff_and_soft(std::vector<Check> &checks, const bool soft_particles)
{
  const double stiff = aluminum().young_modulus, soft = 1e-6 * stiff, v = 0.05;
  const auto material = [&](const double E)
  {
    return std::make_shared<Elastic>(
        ElasticConstants{aluminum().density, E, 0.});
  };
  World world;
  FemOptions fem = inviscid_cells();
  fem.symmetry_boundary_ids = {2, 3, 4, 5};
  SpgOptions spg = inviscid_particles();
  spg.symmetry_faces = 4 + 8 + 16 + 32;
  const double n_stiff = 12, n_soft = 24;
  const double cells = (soft_particles ? n_stiff : n_soft) * h,
               cloud = (soft_particles ? n_soft : n_stiff) * h;
  BoxSpecification box;
  box.size = {{cells, h, h}};
  box.center = {{-0.5 * cells, 0., 0.}};
  box.cell_size = h;
  world.bodies.push_back(
      std::make_unique<FemBody>("cells", 0, make_graded_box(box),
                                material(soft_particles ? stiff : soft), fem));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "particles", 1,
      make_box_cloud({{0.5 * cloud, 0., 0.}}, {{cloud, h, h}}, h),
      material(soft_particles ? soft : stiff), spg));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
  const double towards = soft_particles ? 1. : -1.;
  Body &hard = *world.bodies[soft_particles ? 0 : 1];
  for (Vec &x : hard.nodes().velocity)
    x = vec(towards * v, 0., 0.);
  // Nodes of the tie belong to both.
  for (auto &body : world.bodies)
    for (std::size_t i = 0; i < body->nodes().n_owned; ++i)
      if (std::abs(body->nodes().reference_position[i][0]) < 1e-9)
        body->nodes().velocity[i] = vec(towards * v, 0., 0.);
  world.stepper.initialize();
  EnergyWatch watch(world);
  const auto before = world.momenta();
  // Until the wave in the soft part is 12 mm from the tie.
  const double c = std::sqrt(soft / aluminum().density);
  while (world.stepper.time() < 12e-3 / c)
  {
    world.advance(0.9);
    if (world.stepper.steps() % 100 == 0)
      watch.look();
  }
  watch.look();
  const auto after = world.momenta();
  // A rigid mass rho A L that pushes a bar: v exp(-rho c A t / (rho A L)); half
  // a cell of the soft part starts with it.
  const double exact = v * std::exp(-c * world.stepper.time() / (n_stiff * h));
  const std::string who = soft_particles ? "stiff cells, soft particles: "
                                         : "stiff particles, soft cells: ";
  checks.push_back({who + "speed of the stiff part", exact,
                    towards * hard.measure().velocity[0], 0.05 * exact, "m/s",
                    "rigid mass on a bar, v exp(-c t/L)"});
  checks.push_back({who + "energy residual", 0., watch.residual(), 1e-3, "1",
                    "energy balance", Check::Kind::at_most});
  checks.push_back({who + "momentum after over before", 1.,
                    after[0] / before[0], 1e-10, "1", "conservation"});
  checks.push_back({who + "steps", 0., double(world.stepper.steps()), 0., "1",
                    "", Check::Kind::reported});
}

std::vector<Check> stiffness_ratio()
{
  std::vector<Check> checks;
  stiff_and_soft(checks, true);
  stiff_and_soft(checks, false);
  return checks;
}

/** Cells a hundred times longer than wide: a wave along them and a turn. */
std::vector<Check> aspect_ratio()
{
  const double thin = 10e-6, length = 40e-3,
               c = std::sqrt(aluminum().young_modulus / aluminum().density);
  const auto mesh = [&]
  {
    // Cells of 1 mm along x, 10 um across.
    BoxSpecification box;
    box.size = {{40. * thin, 2. * thin, 2. * thin}};
    box.center = {{20. * thin, 0., 0.}};
    box.cell_size = thin;
    HexMesh mesh = make_graded_box(box);
    for (auto &p : mesh.nodes)
      p[0] *= 100.;
    for (double &v : mesh.volume)
      v *= 100.;
    return mesh;
  };
  World world;
  const double rise = 2e-6, v = 1.;
  FemOptions options = inviscid_cells();
  world.bodies.push_back(std::make_unique<DrivenFemBody>(
      "bar", 0, mesh(), elastic(0.33), options,
      [=](NodalState &n, const double t)
      {
        const double ramp =
            t < rise ? 0.5 * (1. - std::cos(M_PI * t / rise)) : 1.;
        for (std::size_t i = 0; i < n.size(); ++i)
          if (n.reference_position[i][0] < 1e-9)
            n.velocity[i] = vec(v * ramp, n.velocity[i][1], n.velocity[i][2]);
      }));
  world.distribute();
  world.stepper.initialize();
  Crossing near{0.5 * v}, far{0.5 * v};
  const Body &bar = *world.bodies[0];
  while (world.stepper.time() < 1.1 * length / c)
  {
    world.advance(0.9);
    near.sample(world.stepper.time(), velocity_at(bar, 10e-3, 1e-9));
    far.sample(world.stepper.time(), velocity_at(bar, 30e-3, 1e-9));
  }
  std::vector<Check> checks = {{"wave speed along flat cells", c,
                                20e-3 / (far.time - near.time), 0.01 * c, "m/s",
                                "sqrt(E/rho)"},
                               {"steps", 0., double(world.stepper.steps()), 0.,
                                "1", "", Check::Kind::reported}};

  // Free flight with a spin and noise: energy and momenta.
  World free;
  options.hourglass = "stiffness";
  free.bodies.push_back(
      std::make_unique<FemBody>("bar", 0, mesh(), elastic(0.33), options));
  free.distribute();
  NodalState &n = free.bodies[0]->nodes();
  shake(*free.bodies[0], 0.01);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] += cross(vec(0., 0., 100.),
                           n.reference_position[i] - vec(0.5 * length, 0., 0.));
  free.stepper.initialize();
  EnergyWatch watch(free);
  const auto before = free.momenta();
  for (int step = 0; step < 10000; ++step)
  {
    free.advance(0.9);
    if (step % 100 == 0)
      watch.look();
  }
  const auto after = free.momenta();
  checks.push_back({"free bar, 1e4 steps: energy residual", 0.,
                    watch.residual(), 1e-3, "1", "conservation",
                    Check::Kind::at_most});
  checks.push_back({"free bar: angular momentum after over before", 1.,
                    after[5] / before[5], 1e-10, "1", "conservation"});
  return checks;
}

/** One cell of 1 mm on particles 0.1 mm apart: a wave of 6 mm crosses. */
std::vector<Check> spacing_jump()
{
  World world;
  BoxSpecification box;
  box.size = {{6e-3, h, h}};
  box.center = {{-3e-3, 0., 0.}};
  box.cell_size = h;
  FemOptions fem;
  fem.symmetry_boundary_ids = {2, 3, 4, 5};
  SpgOptions spg;
  spg.symmetry_faces = 4 + 8 + 16 + 32;
  world.bodies.push_back(std::make_unique<FemBody>(
      "cells", 0, make_graded_box(box), elastic(0.33), fem));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "particles", 1,
      make_box_cloud({{1.5e-3, 0., 0.}}, {{3e-3, h, h}}, 0.1 * h),
      elastic(0.33), spg));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = world.bodies[0]->nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    const double s = std::sin(M_PI * n.reference_position[i][0] / 6e-3);
    n.velocity[i] = vec(10. * s * s, 0., 0.);
  }
  world.stepper.initialize();
  EnergyWatch watch(world);
  const auto before = world.momenta();
  double crossed = 0.;
  while (world.stepper.time() < 1.2e-6)
  {
    world.advance(0.9);
    watch.look();
    EnergyLedger e;
    world.bodies[1]->add_energies(e);
    crossed = std::max(crossed, (e.kinetic.value() + e.internal.value()) /
                                    world.total_energy());
  }
  const auto after = world.momenta();
  return {{"energy residual", 0., watch.residual(), 2e-3, "1", "energy balance",
           Check::Kind::at_most},
          {"momentum after over before", 1., after[0] / before[0], 1e-12, "1",
           "conservation"},
          {"work of the tie over the energy", 0.,
           world.ledger().tie.value() / world.total_energy(), 1e-12, "1",
           "the tie does no work"},
          {"energy that has crossed", 0.3, crossed, 0., "1",
           "half of the wave runs to the tie", Check::Kind::at_least}};
}

const RegisterProblem a({"extreme-melt", "shear at melt and up to it",
                         "extremes quick", melt}),
    b({"extreme-stiffness-ratio", "moduli 1e6 apart across a tie",
       "extremes quick", stiffness_ratio}),
    c({"extreme-aspect-ratio", "cells a hundred times longer than wide",
       "extremes quick", aspect_ratio}),
    d({"extreme-spacing-jump", "a tie of ratio 1:10", "extremes quick",
       spacing_jump});
} // namespace
} // namespace sabot
