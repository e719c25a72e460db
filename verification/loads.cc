// Loads from outside: free fall, a suddenly loaded bar, prescribed motion.
#include "sabot/bodies/rigid/rigid_body.h"
#include "verification/driven.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <algorithm>
#include <cstdio>

namespace sabot
{
namespace
{
constexpr double g = 9.81;

BoxSpecification block_at(const double x)
{
  BoxSpecification b;
  b.center = {{x, 0., 0.}};
  b.size = {{4e-3, 4e-3, 4e-3}};
  b.cell_size = 1e-3;
  return b;
}

/** Cells, particles, a rigid body and a tied pair, thrown upwards, fall again:
    on the parabola, without strain. */
std::vector<Check> free_fall()
{
  const std::array<double, 3> v{{1., -0.2, 0.5}};
  World world;
  FemOptions fem;
  fem.initial_velocity = v;
  SpgOptions spg;
  spg.initial_velocity = v;
  RigidOptions rigid;
  rigid.initial_velocity = v;
  world.bodies.push_back(std::make_unique<FemBody>(
      "cells", 0, make_graded_box(block_at(0.)), elastic(), fem));
  world.bodies.push_back(std::make_unique<SpgBody>(
      "particles", 1,
      make_box_cloud(block_at(10e-3).center, block_at(0.).size, 1e-3),
      elastic(), spg));
  world.bodies.push_back(std::make_unique<RigidBody>(
      "rigid", 2, make_graded_box(block_at(20e-3)), elastic(), rigid));
  world.add_load("gravity", {{"Acceleration", "0, 0, -9.81 km/s^2"},
                             {"Course", "table"},
                             {"Times", "0 us, 50 us"},
                             {"Factors", "0, 2"}});
  world.distribute();
  world.stepper.initialize();
  const double kinetic = world.ledger().kinetic.value();
  while (world.stepper.time() < 80e-6)
    world.advance(0.9);
  const double t = world.stepper.time(), T = 50e-6, a = 1e3 * g;
  // 2 a t/T up to T, 2 a after it.
  const double speed = a * T + 2. * a * (t - T),
               depth = a * T * T / 3. + a * T * (t - T) + a * (t - T) * (t - T);
  std::vector<Check> checks;
  for (const auto &body : world.bodies)
  {
    double place = 0., velocity = 0.;
    const NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec x = n.position[i] - n.reference_position[i];
      const Vec exact = vec(v[0] * t, v[1] * t, v[2] * t - depth);
      place = std::max(place, norm(x - exact) / depth);
      velocity =
          std::max(velocity,
                   norm(n.velocity[i] - vec(v[0], v[1], v[2] - speed)) / speed);
    }
    // Trapezoids of dt = 0.1 us on a kink.
    checks.push_back({body->name + ": place, error over the depth", 0., place,
                      2e-5, "1", "integral of g(t)"});
    checks.push_back({body->name + ": velocity, error over the change", 0.,
                      velocity, 2e-5, "1", "integral of g(t)"});
  }
  const EnergyLedger e = world.ledger();
  const double gained = e.kinetic.value() - kinetic;
  checks.push_back({"work over kinetic energy gained", 1.,
                    e.external.value() / gained, 2e-5, "1", "energy balance"});
  checks.push_back({"internal energy over it", 0.,
                    world.internal_energy() / gained, 1e-9, "1",
                    "nothing deforms"});
  return checks;
}

/** A bar that is clamped at one end and loaded at once at the other: its end
    goes twice as far as under the load at rest, and comes back. */
std::vector<Check> sudden_bar()
{
  const double E = aluminum().young_modulus, rho = aluminum().density;
  const double c = std::sqrt(E / rho), h = 1e-3, p = 20e6;
  std::vector<Check> checks;
  const auto judge = [&](World &world, const std::string &name, const double L,
                         const double area, const double tolerance)
  {
    world.add_load(
        "traction",
        {{"Body", name}, {"Faces", "1"}, {"Traction", "20 MPa, 0 Pa, 0 Pa"}});
    world.distribute();
    world.stepper.initialize();
    const NodalState &n = world.bodies[0]->nodes();
    const auto tip = [&]
    {
      double mean = 0.;
      int count = 0;
      for (std::size_t i = 0; i < n.n_owned; ++i)
        if (n.reference_position[i][0] > L - 0.1 * h)
        {
          mean += n.position[i][0] - L;
          ++count;
        }
      return mean / count;
    };
    const double still = p * L / E;
    double most = 0., when = 0., residual = 0., work = 0.;
    while (world.stepper.time() < 4. * L / c)
    {
      world.advance(0.5);
      if (tip() > most)
      {
        most = tip();
        when = world.stepper.time();
      }
      work = std::max(work, world.ledger().external.value());
      residual = std::max(residual, std::abs(world.total_energy()));
    }
    checks.push_back({name + ": largest over static displacement of the end",
                      2., most / still, tolerance, "1", "sudden load"});
    checks.push_back({name + ": its time over L/c", 2., when * c / L, 0.05, "1",
                      "wave there and back"});
    checks.push_back({name + ": displacement after 4 L/c over static one", 0.,
                      tip() / still, 0.1, "1", "back at rest"});
    checks.push_back({name + ": work over force times displacement", 1.,
                      work / (p * area * most), 1e-3, "1", "dead load"});
    checks.push_back({name + ": energy residual over it", 0., residual / work,
                      2e-3, "1", "energy balance"});
  };
  {
    World world;
    FemOptions options;
    options.clamped_boundary_ids = {0};
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    world.bodies.push_back(std::make_unique<FemBody>(
        "cells", 0, make_bar(0., 100, h), elastic(0.), options));
    judge(world, "cells", 100. * h, h * h, 0.03);
  }
  {
    World world;
    SpgOptions options;
    options.clamped_faces = 1;
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    const double L = 50e-3, width = 2e-3;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "particles", 0,
        make_box_cloud({{0.5 * L, 0., 0.}}, {{L, width, width}}, h),
        elastic(0.), options));
    judge(world, "particles", L, width * width, 0.05);
  }
  return checks;
}

/** A rigid block that a load turns by a quarter: pressure on a face turns with
    it, traction does not; motions end where their courses' integrals say. */
std::vector<Check> prescribed()
{
  World world;
  world.bodies.push_back(std::make_unique<RigidBody>(
      "block", 0, make_graded_box(block_at(0.)), elastic(), RigidOptions()));
  FemOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  world.bodies.push_back(std::make_unique<FemBody>(
      "bar", 1, make_bar(20e-3, 20, 1e-3), elastic(0.), options));
  // Rises and falls: the mean of the factor is 1/2.
  const double T = 100e-6, quarter = 0.5 * M_PI;
  const std::vector<std::pair<std::string, std::string>> course = {
      {"Course", "table"},
      {"Times", "0 us, 30 us, 100 us"},
      {"Factors", "0, 1, 0"}};
  const auto with_course =
      [&](std::vector<std::pair<std::string, std::string>> values)
  {
    values.insert(values.end(), course.begin(), course.end());
    return values;
  };
  char spin[60];
  std::snprintf(spin, sizeof(spin), "0, 0, %.17g", quarter / (0.5 * T));
  world.add_load("prescribed motion",
                 with_course({{"Body", "block"},
                              {"Velocity", "10 m/s, 0 m/s, 20 m/s"},
                              {"Angular velocity", spin}}));
  world.add_load("pressure",
                 {{"Body", "block"}, {"Faces", "0"}, {"Pressure", "1 MPa"}});
  world.add_load(
      "traction",
      {{"Body", "block"}, {"Faces", "0"}, {"Traction", "1 MPa, 0 Pa, 0 Pa"}});
  world.add_load("prescribed motion",
                 with_course({{"Body", "bar"},
                              {"Faces", "0"},
                              {"Components", "x"},
                              {"Velocity", "5 m/s, 7 m/s, 0 m/s"}}));
  world.distribute();
  world.stepper.initialize();
  double residual = 0., work = 0.;
  while (world.stepper.time() < 0.9 * T)
  {
    world.stepper.advance(0.1e-6);
    world.stepper.update();
    residual = std::max(residual, std::abs(world.total_energy()));
    work = std::max(work, world.ledger().external.value());
  }
  while (world.stepper.time() < 1.1 * T)
    world.stepper.advance(0.1e-6);
  const auto force = [&](const int load, const int axis)
  { return world.loads[load]->resultants()[0].force[axis]; };
  const NodalState &block = world.bodies[0]->nodes(),
                   &bar = world.bodies[1]->nodes();
  Vec center{};
  for (std::size_t i = 0; i < block.n_owned; ++i)
    center += (1. / block.n_owned) * block.position[i];
  double end = 0.;
  for (std::size_t i = 0; i < bar.n_owned; ++i)
    if (bar.reference_position[i][0] < 20.1e-3)
      end = std::max(end, std::abs(bar.position[i][0] - 20e-3 - 2.5 * T));
  const double F = 1e6 * 16e-6;
  return {{"pressure along its first direction, over p A", 0., force(1, 0) / F,
           1e-6, "1", "turned by a quarter"},
          {"pressure along its last direction", 1., force(1, 1) / F, 1e-6, "1",
           "turned by a quarter"},
          {"traction along its direction", 1., force(2, 0) / F, 1e-12, "1",
           "dead load"},
          {"block: place", 0.,
           norm(center - vec(5. * T, 0., 10. * T)) / (10. * T), 1e-9, "1",
           "integral of the velocity"},
          {"end of the bar: error of its place over the way", 0.,
           end / (2.5 * T), 1e-9, "1", "integral of the velocity"},
          {"energy residual over the largest work", 0., residual / work, 2e-3,
           "1", "energy balance"}};
}

const RegisterProblem a({"load-free-fall", "bodies of all kinds under gravity",
                         "quick", free_fall}),
    b({"load-sudden-bar", "a suddenly loaded bar goes twice as far", "quick",
       sudden_bar}),
    c({"load-prescribed", "prescribed motion, and loads that turn with it",
       "quick", prescribed});
} // namespace
} // namespace sabot
