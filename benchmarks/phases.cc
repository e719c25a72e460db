// Each phase of a run by itself, CPU time per item at 10^3 to 10^6 items:
// build/release/benchmark_phases; the exchange with
// mpirun -np 2 build/release/benchmark_phases --benchmark_filter=exchange
#include "sabot/base/choice.h"
#include "sabot/base/mpi_session.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/output/run_files.h"
#include "verification/world.h"

#include <benchmark/benchmark.h>

#include <filesystem>

namespace
{
using namespace sabot;

constexpr double h = 1e-3, dt = 2e-8; // [m], [s]

/** Particles at an edge of @p n, which move as @p rate [1/s] squeezes them. */
Body &add_particles(World &world, const int n, const SpgOptions &options,
                    const double rate = 1e4)
{
  const double edge = (n - 1) * h;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, perturbed_cloud({{edge, edge, edge}}, h, 0.1),
      metal("al6061-t6"), options));
  world.distribute();
  Body &body = *world.bodies[0];
  NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Vec X = nodes.reference_position[i];
    nodes.velocity[i] = rate * vec(-X[0], 0.5 * X[1] + 0.1 * X[0], 0.5 * X[2]);
  }
  world.stepper.initialize();
  return body;
}

/** Move by @p step; forth where @p way is 1, back where it is -1. */
void drift(Body &body, const double step)
{
  NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    nodes.position[i] += step * nodes.velocity[i];
}

void set_items(benchmark::State &state, const double n)
{
  state.counters["items"] = n;
  state.counters["ns per item"] = benchmark::Counter(
      1e-9 * n, benchmark::Counter::kIsIterationInvariantRate |
                    benchmark::Counter::kInvert);
}

SpgOptions stabilized_by(const std::string &name)
{
  SpgOptions options;
  options.stabilization = choose<Stabilization>(name);
  return options;
}

/** The SPG step without or with residuals, without or with the material. */
void run_step(benchmark::State &state, const std::string &form,
              const double step)
{
  World world;
  Body &body = add_particles(world, state.range(0), stabilized_by(form));
  int count = 0;
  double way = 1.;
  for (auto _ : state)
  {
    if (++count % 200 == 0)
      way = -way;
    drift(body, way * step);
    body.compute_forces(0., step);
  }
  set_items(state, body.n_items());
}
void gradients_and_gather(benchmark::State &state)
{
  run_step(state, "none", no_step);
}
void gradients_residuals_and_gather(benchmark::State &state)
{
  run_step(state, "bond residual", no_step);
}
void gradients_law_and_gather(benchmark::State &state)
{
  run_step(state, "none", dt);
}
void spg_step(benchmark::State &state)
{
  run_step(state, "bond residual", dt);
}

void kernel_update(benchmark::State &state)
{
  World world;
  Body &body = add_particles(world, state.range(0), SpgOptions());
  unsigned int step = 0;
  double way = 1.;
  for (auto _ : state)
  {
    state.PauseTiming();
    drift(body, way * 3e-6); // a strain of three hundredths
    way = -way;
    body.compute_forces(0., no_step);
    state.ResumeTiming();
    step += SpgOptions().kernel_update_interval;
    if (!body.update_topology(step, 0.))
      state.SkipWithError("no kernel update was due");
  }
  set_items(state, body.n_items());
}

void failure_check(benchmark::State &state)
{
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(10.);
  Body &body = add_particles(world, state.range(0), options);
  const unsigned int step = options.failure_check_interval;
  for (auto _ : state)
    if (body.update_topology(step, 0.))
      state.SkipWithError("bonds have failed");
  set_items(state, body.n_items());
}

/** Two plates of cells, four thick, that touch; items are nodes that may meet
    faces. */
struct Plates
{
  World world;
  Coupling *contact;

  explicit Plates(const int n)
  {
    for (const int side : {-1, 1})
    {
      BoxSpecification box;
      box.size = {{n * h, n * h, 4 * h}};
      box.center = {{0.3 * h * side, 0., side * (2. - 0.01) * h}};
      box.cell_size = h;
      FemOptions options;
      options.initial_velocity = {{0., 0., -10. * side}};
      world.bodies.push_back(std::make_unique<FemBody>(
          side < 0 ? "lower" : "upper", world.bodies.size(),
          make_graded_box(box), elastic(), options));
    }
    const std::vector<ContactPair> pairs = {{0, 1, false}, {1, 0, false}};
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    world.stepper.initialize();
    contact = world.couplings[0].get();
  }
};

void contact(benchmark::State &state)
{
  Plates plates(state.range(0));
  for (auto _ : state)
    plates.contact->add_forces(dt);
  set_items(state, plates.contact->n_items());
}

void contact_search(benchmark::State &state)
{
  Plates plates(state.range(0));
  for (auto _ : state)
    plates.contact->update_search(0, 1.); // as if they had moved for a second
  set_items(state, plates.contact->n_items());
}

/** A block of which all bonds have failed. */
struct Debris
{
  World world;
  Coupling *contact;

  explicit Debris(const int n)
  {
    SpgOptions options;
    options.set_critical_plastic_strain(1e-3);
    const double edge = (n - 1) * h;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, make_box_cloud({{0., 0., 0.}}, {{edge, edge, edge}}, h),
        metal("al6061-t6"), options));
    world.couplings.push_back(std::make_unique<SelfContact>(
        "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
        SelfContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    NodalState &nodes = world.bodies[0]->nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes.velocity[i] = 2e4 * nodes.reference_position[i];
    world.stepper.initialize();
    while (world.stepper.time() < 10e-6)
      world.advance(0.9);
    for (Vec &v : nodes.velocity)
      v = -1. * v;
    contact = world.couplings[0].get();
    contact->update_search(0, 1.);
  }
};

void self_contact(benchmark::State &state)
{
  Debris debris(state.range(0));
  for (auto _ : state)
    debris.contact->add_forces(dt);
  set_items(state, debris.contact->n_items());
}

void self_contact_search(benchmark::State &state)
{
  Debris debris(state.range(0));
  for (auto _ : state)
    debris.contact->update_search(0, 1.);
  set_items(state, debris.contact->n_items());
}

/** Positions to the ghosts of other ranks; items are ghosts. */
void exchange(benchmark::State &state)
{
  World world;
  Body &body = add_particles(world, state.range(0), SpgOptions());
  for (auto _ : state)
    body.update_ghosts();
  set_items(state, body.nodes().size() - body.nodes().n_owned);
}

/** What a row of the histories asks of a body. */
void balance(benchmark::State &state)
{
  World world;
  Body &body = add_particles(world, state.range(0), SpgOptions());
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(world.total_energy());
    ExactSum kick;
    body.add_kick_energy(dt, kick);
    benchmark::DoNotOptimize(body.measure());
  }
  set_items(state, body.n_items());
}

void output(benchmark::State &state)
{
  World world;
  Body &body = add_particles(world, state.range(0), SpgOptions());
  const auto folder =
      std::filesystem::temp_directory_path() / "sabot-benchmark-output";
  std::filesystem::create_directories(folder);
  {
    RunFiles files(folder, MPI_COMM_WORLD);
    files.open_fields();
    double time = 0.;
    for (auto _ : state)
      files.write_fields(time += 1., {&body});
  }
  std::filesystem::remove_all(folder);
  set_items(state, body.n_items());
}

/** 10^3, 10^4, 10^5 items. */
void of_cubes(benchmark::internal::Benchmark *const phase)
{
  for (const int n : {10, 22, 47})
    phase->Arg(n);
}
/** And, where memory and time allow it, 10^6. */
void of_large_cubes(benchmark::internal::Benchmark *const phase)
{
  of_cubes(phase);
  phase->Arg(100);
}
/** 10^3 to 10^5 nodes that may touch. */
void of_plates(benchmark::internal::Benchmark *const phase)
{
  for (const int n : {22, 70, 220})
    phase->Arg(n);
}

BENCHMARK(gradients_and_gather)->Apply(of_cubes);
BENCHMARK(gradients_residuals_and_gather)->Apply(of_cubes);
BENCHMARK(gradients_law_and_gather)->Apply(of_cubes);
BENCHMARK(spg_step)->Apply(of_large_cubes);
BENCHMARK(kernel_update)->Apply(of_cubes);
BENCHMARK(failure_check)->Apply(of_large_cubes);
BENCHMARK(contact)->Apply(of_plates);
BENCHMARK(contact_search)->Apply(of_plates);
BENCHMARK(self_contact)->Apply(of_cubes);
BENCHMARK(self_contact_search)->Apply(of_cubes);
// As often on every rank
BENCHMARK(exchange)->Apply(of_cubes)->Iterations(300);
BENCHMARK(balance)->Apply(of_large_cubes);
BENCHMARK(output)->Apply(of_cubes);
} // namespace

int main(int argc, char **argv)
{
  const sabot::MpiSession mpi(argc, argv);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
