// Large rotations of soft hexahedra: a spinning plate, a twisting column.
#include "sabot/materials/laws.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
HexMesh box(const std::array<double, 3> &size,
            const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return make_graded_box(b);
}

FemOptions inviscid(const std::string &integration)
{
  FemOptions o;
  o.integration = integration;
  o.hourglass = "stiffness";
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  return o;
}

/** A plate of 1 x 1 x 0.1 m at 50 rad/s makes four turns in 0.5 s (rho 1100,
    E 17 MPa, nu 0.45; a case of SPHinXsys). It rings about its centrifugal
    stretch; nothing may grow. */
std::vector<Check> spinning_plate()
{
  std::vector<Check> checks;
  for (const std::string integration : {"one point", "B-bar"})
  {
    World world;
    world.bodies.push_back(std::make_unique<FemBody>(
        "plate", 0, box({{1., 1., 0.1}}, {{0., 0., 0.}}, 0.1),
        std::make_shared<Elastic>(ElasticConstants{1100., 17e6, 0.45}),
        inviscid(integration)));
    world.distribute();
    auto &body = static_cast<FemBody &>(*world.bodies[0]);
    NodalState &n = body.nodes();
    const double omega = 50.;
    for (std::size_t i = 0; i < n.size(); ++i)
      n.velocity[i] = cross(vec(0., 0., omega), n.reference_position[i]);
    world.stepper.initialize();
    EnergyWatch watch(world);
    const auto before = world.momenta();
    double early = 0., late = 0., turned = 0.;
    int n_early = 0, n_late = 0;
    // Trace of the stress: the same in any frame that turns with the plate.
    const auto mean_stress = [&]
    {
      double sum = 0.;
      for (std::size_t e = 0; e < body.n_local_cells(); ++e)
        sum += body.stress(0, e) + body.stress(1, e) + body.stress(2, e);
      return sum / body.n_local_cells();
    };
    const double end = 10. * 2. * M_PI / omega;
    while (world.stepper.time() < end)
    {
      world.advance(0.7);
      turned = omega * world.stepper.time() / (2. * M_PI);
      if (turned < 5.)
        early += mean_stress(), ++n_early;
      else
        late += mean_stress(), ++n_late;
      if (world.stepper.steps() % 10 == 0)
        watch.look();
    }
    const auto after = world.momenta();
    // Rotating square plate: mean of the trace of the stress is
    // rho omega^2 <x^2 + y^2> (virial theorem).
    const double virial = 1100. * omega * omega * (1. / 12. + 1. / 12.);
    const std::string who =
        integration == "one point" ? "one point: " : "B-bar: ";
    checks.push_back({who + "angular momentum, relative change", 0.,
                      after[5] / before[5] - 1., 1e-10, "1", "conservation"});
    checks.push_back({who + "energy residual", 0., watch.residual(), 1e-3, "1",
                      "conservation", Check::Kind::at_most});
    checks.push_back({who + "mean stress, turns 6-10 over 1-5", 1.,
                      late / n_late * n_early / early, 0.03, "1", "no growth"});
    checks.push_back({who + "mean trace of the stress", virial,
                      (early + late) / (n_early + n_late), 0.06 * virial, "Pa",
                      "virial: rho omega^2 <r^2>, undeformed"});
  }
  return checks;
}

struct Column
{
  double twist, time, residual, lowest_volume; // [rad], [s]
};

/** 6 x 1 x 1 m, omega = 105 sin(pi z/12) rad/s, the foot held (Haider, Lee,
    Gil & Bonet 2017), neo-Hookean: largest twist of the tip and its time. */
Column twist_column(std::unique_ptr<Body> made, const bool hold_by_inertia)
{
  World world;
  world.bodies.push_back(std::move(made));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    n.velocity[i] = 105. * std::sin(M_PI * X[2] / 12.) * vec(-X[1], X[0], 0.);
    if (X[2] < 1e-9 && hold_by_inertia)
    {
      n.velocity[i] = Vec{};
      n.inertia[i] = 1e9 * n.lumped_mass[i];
    }
  }
  world.stepper.initialize();
  EnergyWatch watch(world);
  std::size_t tip = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    if (X[2] > 6. - 1e-9 && X[0] > 0.5 - 1e-9 && std::abs(X[1]) < 1e-9)
      tip = i;
  }
  Column column{0., 0., 0., 1.};
  double angle = 0., last = 0.;
  while (world.stepper.time() < 0.12)
  {
    world.advance(0.7);
    if (world.stepper.steps() % 10 == 0)
      watch.look();
    const double now = std::atan2(n.position[tip][1], n.position[tip][0]);
    angle += std::remainder(now - last, 2. * M_PI);
    last = now;
    if (angle > column.twist)
    {
      column.twist = angle;
      column.time = world.stepper.time();
    }
  }
  column.residual = watch.residual();
  return column;
}

std::vector<Check> twisting_columns()
{
  const auto rubber =
      std::make_shared<NeoHookean>(ElasticConstants{1100., 17e6, 0.45});
  std::vector<Check> checks;
  double fem[3], fem_time[3];
  int k = 0;
  const auto report = [&](const std::string &who, const Column &c)
  {
    checks.push_back({who + "largest twist of the tip", 0., c.twist, 0., "rad",
                      "", Check::Kind::reported});
    checks.push_back(
        {who + "its time", 0., c.time, 0., "s", "", Check::Kind::reported});
    checks.push_back({who + "energy residual", 0.01, c.residual, 0., "1",
                      "conservation", Check::Kind::at_most});
  };
  for (const double h : {1. / 4., 1. / 8., 1. / 16.})
  {
    FemOptions options = inviscid("B-bar");
    options.clamped_boundary_ids = {4};
    const Column c =
        twist_column(std::make_unique<FemBody>(
                         "column", 0, box({{1., 1., 6.}}, {{0., 0., 3.}}, h),
                         rubber, options),
                     false);
    fem[k] = c.twist;
    fem_time[k++] = c.time;
    report("B-bar, 1/" + std::to_string(int(1. / h)) + " m: ", c);
  }
  const double order = std::log2((fem[0] - fem[1]) / (fem[1] - fem[2])),
               limit = fem[2] + (fem[2] - fem[1]) / 3.,
               limit_time = fem_time[2] + (fem_time[2] - fem_time[1]) / 3.;
  checks.push_back({"order of the twist of the cells", 2., order, 0., "1",
                    "three meshes", Check::Kind::reported});
  checks.push_back({"twist, extrapolated by second order", 0., limit, 0., "rad",
                    "", Check::Kind::reported});
  {
    FemOptions options = inviscid("one point");
    options.clamped_boundary_ids = {4};
    const Column c = twist_column(
        std::make_unique<FemBody>("column", 0,
                                  box({{1., 1., 6.}}, {{0., 0., 3.}}, 1. / 8.),
                                  rubber, options),
        false);
    report("one point, 1/8 m: ", c);
    // The hourglass stiffness holds the section a little.
    checks.push_back({"one point, 1/8 m: twist over the limit", 1.,
                      c.twist / limit, 0.05, "1", "converged B-bar cells"});
  }
  double error[2];
  for (int i = 0; i < 2; ++i)
  {
    const double h = i == 0 ? 1. / 6. : 1. / 12.;
    SpgOptions options;
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    const Column c = twist_column(
        std::make_unique<SpgBody>(
            "column", 0, make_box_cloud({{0., 0., 3.}}, {{1., 1., 6.}}, h),
            rubber, options),
        true);
    report(i == 0 ? "particles, 1/6 m: " : "particles, 1/12 m: ", c);
    error[i] = c.twist / limit - 1.;
    checks.push_back({i == 0 ? "particles, 1/6 m: twist over the limit"
                             : "particles, 1/12 m: twist over the limit",
                      1., c.twist / limit, i == 0 ? 0.1 : 0.03, "1",
                      "converged B-bar cells"});
    if (i == 1)
      checks.push_back({"particles, 1/12 m: time of the largest twist over the "
                        "limit",
                        1., c.time / limit_time, 0.03, "1",
                        "converged B-bar cells"});
  }
  checks.push_back({"order of the particles' error", 1.5,
                    std::log2(std::abs(error[0] / error[1])), 0., "1",
                    "two spacings", Check::Kind::reported});
  return checks;
}

const RegisterProblem a({"fem-spinning-plate",
                         "a soft plate, ten turns at 50 rad/s", "extremes long",
                         spinning_plate}),
    b({"twisting-column", "rubber column, cells and particles converge", "long",
       twisting_columns});
} // namespace
} // namespace sabot
