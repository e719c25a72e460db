// CPU time of the force loop of a FEM block, per cell-step:
// build/release/benchmark_fem_step; see doc/performance.md
#include "sabot/base/mpi_session.h"
#include "verification/world.h"

#include <benchmark/benchmark.h>

namespace
{
using namespace sabot;

/** A block that is compressed at @p rate [1/s], slowly enough for the cells to
    keep their shape over all repetitions. */
void step(benchmark::State &state, const FemOptions &options, const double rate,
          const bool plastic)
{
  const double n = state.range(0), h = 1e-3;
  World world;
  BoxSpecification box;
  box.size = {{n * h, n * h, n * h}};
  box.cell_size = h;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, make_graded_box(box),
      plastic ? metal("al6061-t6") : elastic(), options));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes.velocity[i] = vec(-rate * nodes.reference_position[i][0], 0., 0.);
  world.stepper.initialize();
  constexpr double dt = 5e-8;
  // To and fro, so that any number of repetitions may be asked for.
  int count = 0;
  for (auto _ : state)
  {
    if (++count % 400 == 0)
      for (Vec &v : nodes.velocity)
        v = -1. * v;
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      nodes.position[i] += dt * nodes.velocity[i];
    body.compute_forces(0., dt);
  }
  state.counters["items"] = body.n_items();
}

void elastic_viscous(benchmark::State &state)
{
  step(state, FemOptions(), 1e4, false);
}
void elastic_stiffness(benchmark::State &state)
{
  FemOptions options;
  options.hourglass = "stiffness";
  step(state, options, 1e4, false);
}
void elastic_b_bar(benchmark::State &state)
{
  FemOptions options;
  options.integration = "B-bar";
  step(state, options, 1e4, false);
}
void johnson_cook_below_yield(benchmark::State &state)
{
  step(state, FemOptions(), 1., true);
}
void johnson_cook_viscous(benchmark::State &state)
{
  step(state, FemOptions(), 1e4, true);
}
void johnson_cook_stiffness(benchmark::State &state)
{
  FemOptions options;
  options.hourglass = "stiffness";
  step(state, options, 1e4, true);
}
void johnson_cook_b_bar(benchmark::State &state)
{
  FemOptions options;
  options.integration = "B-bar";
  step(state, options, 1e4, true);
}
// 10: in the cache
BENCHMARK(elastic_viscous)->Arg(10)->Arg(22);
BENCHMARK(elastic_stiffness)->Arg(22);
BENCHMARK(elastic_b_bar)->Arg(22);
BENCHMARK(johnson_cook_below_yield)->Arg(22);
BENCHMARK(johnson_cook_viscous)->Arg(22)->Arg(47);
BENCHMARK(johnson_cook_stiffness)->Arg(22);
BENCHMARK(johnson_cook_b_bar)->Arg(22);
} // namespace

int main(int argc, char **argv)
{
  const sabot::MpiSession mpi(argc, argv);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
