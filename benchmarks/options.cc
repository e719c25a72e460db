// What each option costs: CPU time of the force loop of a plastic block per
// item with the option on and off; build/release/benchmark_options
#include "sabot/base/choice.h"
#include "sabot/base/mpi_session.h"
#include "verification/world.h"

#include <benchmark/benchmark.h>

#include <functional>

namespace
{
using namespace sabot;
using Law = std::shared_ptr<const Material>;

/** What is done between steps (erosion, failure, kernel updates, conduction)
    counts, too. */
constexpr bool with_updates = true;

void run(benchmark::State &state, World &world, const bool updates)
{
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  // Stretch and shear at about 1e4 1/s: plastic after the first 0.5 us.
  constexpr double rate = 1e4, dt = 2e-8;
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    const Vec X = n.reference_position[i];
    n.velocity[i] = vec(-rate * X[0] + 0.3 * rate * X[1], 0.2 * rate * X[1],
                        0.1 * rate * X[2]);
  }
  world.stepper.initialize();
  unsigned int step = 0;
  for (auto _ : state)
  {
    for (std::size_t i = 0; i < n.size(); ++i)
      n.position[i] += dt * n.velocity[i];
    ++step;
    body.compute_forces(step * dt, dt);
    if (updates)
      body.update_topology(step, step * dt);
  }
  state.counters["items"] = body.n_items();
}

// As many steps as keep the strain below a fifth.
void add(const std::string &name,
         const std::function<void(benchmark::State &)> &body, const int n_steps)
{
  benchmark::RegisterBenchmark(name.c_str(), body)
      ->Iterations(n_steps)
      ->Repetitions(5)
      ->ReportAggregatesOnly();
}

void cells(const std::string &name, const FemOptions &options, const Law &law,
           const bool updates = false)
{
  add(
      "cells/" + name,
      [=](benchmark::State &state)
      {
        World world;
        BoxSpecification box;
        box.size = {{16e-3, 16e-3, 16e-3}};
        box.cell_size = 1e-3;
        world.bodies.push_back(std::make_unique<FemBody>(
            "block", 0, make_graded_box(box), law, options));
        run(state, world, updates);
      },
      200);
}

void particles(const std::string &name, const SpgOptions &options,
               const Law &law, const bool updates = false)
{
  add(
      "particles/" + name,
      [=](benchmark::State &state)
      {
        World world;
        world.bodies.push_back(std::make_unique<SpgBody>(
            "block", 0,
            make_box_cloud({{0, 0, 0}}, {{15e-3, 15e-3, 15e-3}}, 1e-3), law,
            options));
        run(state, world, updates);
      },
      50);
}

Law aluminum_with(const std::vector<std::string> &changes)
{
  return metal("al6061-t6", changes);
}

void add_laws()
{
  const std::vector<std::pair<std::string, Law>> laws = {
      {"all off", metal("al6061-t6")},
      {"Mie-Gruneisen", metal("al6061-t6-eos")},
      {"damage", aluminum_with({"Johnson-Cook/Damage=true"})},
      {"no heating", aluminum_with({"Johnson-Cook/Taylor-Quinney fraction=0"})},
      {"thermal expansion",
       aluminum_with({"Johnson-Cook/Thermal expansion=23e-6"})}};
  for (const auto &[name, law] : laws)
  {
    cells(name, FemOptions(), law);
    particles(name, SpgOptions(), law);
  }
}

void add_cells(const Law &law)
{
  FemOptions o;
  o.objective_rate = FemOptions::ObjectiveRate::green_naghdi;
  cells("Green-Naghdi rate", o, law);
  o = FemOptions();
  o.hourglass = "stiffness";
  cells("stiffness hourglass control", o, law);
  o = FemOptions();
  o.hourglass_coefficient = 0.;
  cells("hourglass coefficient 0", o, law);
  o = FemOptions();
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  cells("no bulk viscosity", o, law);
  o = FemOptions();
  o.integration = "B-bar";
  cells("B-bar", o, law);

  cells("with updates: all off", FemOptions(), law, with_updates);
  o = FemOptions();
  o.erosion_plastic_strain = 100.;
  cells("with updates: erosion, none due", o, law, with_updates);
  const Law conducting =
      aluminum_with({"Johnson-Cook/Thermal conductivity=167"});
  o = FemOptions();
  o.conducts_heat = true;
  o.conduction_interval = 0.; // every step; usually many
  cells("with updates: conduction in every step", o, conducting, with_updates);
  o.conduction_interval = 1.;
  cells("with updates: conduction, none due", o, conducting, with_updates);
}

void add_particles(const Law &law)
{
  SpgOptions o;
  o.stabilization = choose<Stabilization>("none");
  particles("no stabilization", o, law);
  o = SpgOptions();
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  particles("no bulk viscosity", o, law);
  o = SpgOptions();
  o.approximation = SpgOptions::Approximation::convex_exponential;
  o.kernel_shape = SpgOptions::KernelShape::tensor;
  o.normalized_support = 1.5;
  particles("convex 1.5, bond residual", o, law);
  o.stabilization = choose<Stabilization>("none");
  particles("convex 1.5, no stabilization", o, law);
  o.stabilization = choose<Stabilization>("second gradient");
  particles("convex 1.5, second gradient", o, law);

  o = SpgOptions();
  o.kernel_update_interval = 1000000;
  o.kernel_update_change = 10.;
  particles("with updates: no kernel updates, no failure", o, law,
            with_updates);
  particles("with updates: kernel update every 30 steps", SpgOptions(), law,
            with_updates);
  o.set_critical_plastic_strain(100.);
  particles("with updates: failure, none due", o, law, with_updates);
  o = SpgOptions();
  o.stabilization = choose<Stabilization>("velocity smoothing");
  particles("with updates: velocity smoothing", o, law, with_updates);
}
} // namespace

int main(int argc, char **argv)
{
  const sabot::MpiSession mpi(argc, argv);
  add_laws();
  add_cells(metal("al6061-t6"));
  add_particles(metal("al6061-t6"));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
