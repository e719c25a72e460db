// CPU time of the force loop of an SPG block, per particle-step.
// spg_step --benchmark_filter=... ; see doc/performance.md
#include "sabot/base/choice.h"
#include "sabot/base/mpi_session.h"
#include "verification/world.h"

#include <benchmark/benchmark.h>

namespace
{
using namespace sabot;

void step(benchmark::State &state, const SpgOptions &options,
          const double speed, const bool plastic)
{
  const double n = state.range(0), h = 1e-3;
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0,
      perturbed_cloud({{(n - 1) * h, (n - 1) * h, (n - 1) * h}}, h, 0.1),
      plastic ? metal("al6061-t6") : elastic(), options));
  world.distribute();
  auto &body = *world.bodies[0];
  for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
  {
    const Vec X = body.nodes().reference_position[i];
    body.nodes().velocity[i] = speed / (n * h) * vec(-X[2], X[0], X[1]);
  }
  world.stepper.initialize();
  for (int i = 0; i < 20; ++i)
    world.advance(0.5);
  const double dt = 0.5 * world.stepper.propose(false).dt;
  for (auto _ : state)
  {
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      body.nodes().position[i] += dt * body.nodes().velocity[i];
    body.compute_forces(0., dt);
  }
  state.counters["items"] = body.n_items();
}

SpgOptions with(const std::string &s)
{
  SpgOptions o;
  o.stabilization = choose<Stabilization>(s);
  return o;
}

void elastic_unstabilized(benchmark::State &state)
{
  step(state, with("none"), 10., false);
}
void elastic_bond_residual(benchmark::State &state)
{
  step(state, SpgOptions(), 10., false);
}
void johnson_cook_unstabilized(benchmark::State &state)
{
  step(state, with("none"), 300., true);
}
void johnson_cook_bond_residual(benchmark::State &state)
{
  step(state, SpgOptions(), 300., true);
}
void convex_bond_residual(benchmark::State &state)
{
  SpgOptions o;
  o.approximation = SpgOptions::Approximation::convex_exponential;
  o.kernel_shape = SpgOptions::KernelShape::tensor;
  o.normalized_support = 1.5;
  step(state, o, 300., true);
}
void convex_second_gradient(benchmark::State &state)
{
  SpgOptions o = with("second gradient");
  o.approximation = SpgOptions::Approximation::convex_exponential;
  o.kernel_shape = SpgOptions::KernelShape::tensor;
  o.normalized_support = 1.5;
  step(state, o, 300., true);
}
BENCHMARK(elastic_unstabilized)->Arg(22);
BENCHMARK(elastic_bond_residual)->Arg(22);
BENCHMARK(johnson_cook_unstabilized)->Arg(22);
BENCHMARK(johnson_cook_bond_residual)->Arg(22)->Arg(47)->Arg(100);
BENCHMARK(convex_bond_residual)->Arg(22);
BENCHMARK(convex_second_gradient)->Arg(22);
} // namespace

int main(int argc, char **argv)
{
  const sabot::MpiSession mpi(argc, argv);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
