#include "verification/problem.h"
#include "verification/world.h"

#include <ctime>

namespace sabot
{
namespace
{
/** Processor time per cell and step of the force loop alone [ns]. */
double cost(const FemOptions &options, std::shared_ptr<const Material> material,
            const double rate, const unsigned int n_edge = 30)
{
  World world;
  BoxSpecification b;
  b.size = {{n_edge * 1e-3, n_edge * 1e-3, n_edge * 1e-3}};
  b.cell_size = 1e-3;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, make_graded_box(b), std::move(material), options));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
    n.velocity[i] = vec(-rate * n.reference_position[i][0], 0., 0.);
  world.integrator.initialize();
  constexpr double dt = 5e-8;
  const auto advance = [&](const int n_steps)
  {
    double seconds = 0.;
    for (int step = 0; step < n_steps; ++step)
    {
      for (std::size_t i = 0; i < n.size(); ++i)
        n.position[i] += dt * n.velocity[i];
      const std::clock_t start = std::clock();
      body.compute_forces(0., dt);
      seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    }
    return seconds;
  };
  advance(20);
  const int n_steps = 1200000 / body.n_items();
  return 1e9 * advance(n_steps) / (n_steps * double(body.n_items()));
}

std::vector<Check> costs()
{
  JohnsonCookParameters p;
  p.A = 324e6;
  p.B = 114e6;
  p.n = 0.42;
  p.C = 0.002;
  p.m = 1.34;
  p.melt_temperature = 925.;
  p.specific_heat = 896.;
  const ElasticConstants aluminium{2700., 69e9, 0.33};
  const auto johnson_cook = std::make_shared<JohnsonCook>(aluminium, p);
  const auto law = std::make_shared<Elastic>(aluminium);
  FemOptions viscous, stiffness, b_bar;
  stiffness.hourglass = "stiffness";
  b_bar.integration = "B-bar";
  const auto measured = [](const std::string &name, const double ns)
  {
    return Check{name,
                 0.,
                 ns,
                 0.,
                 "ns",
                 "processor time per cell and step",
                 Check::Kind::reported};
  };
  return {
      measured("one point, elastic", cost(viscous, law, 1e4)),
      measured("one point, elastic, stiffness control",
               cost(stiffness, law, 1e4)),
      measured("one point, Johnson-Cook, elastic",
               cost(viscous, johnson_cook, 1.)),
      measured("one point, Johnson-Cook, plastic",
               cost(viscous, johnson_cook, 1e4)),
      measured("one point, elastic, 1000 cells (in cache)",
               cost(viscous, law, 1e4, 10)),
      measured("B-bar, elastic", cost(b_bar, law, 1e4)),
      measured("B-bar, Johnson-Cook, plastic", cost(b_bar, johnson_cook, 1e4))};
}

const RegisterProblem
    registered({"fem-cost", "processor time of the force loop", "long", costs});
} // namespace
} // namespace sabot
