// The hot loops on a small case, for counting their instructions under
// callgrind: scripts/instruction_counts.py. Built for x86-64-v3, for valgrind
// knows no AVX-512; so it has objects of its own and nothing of the program's.
#include "benchmarks/law_batch.h"
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/materials/laws.h"

#include <valgrind/callgrind.h>

#include <cstdio>
#include <functional>
#include <stdexcept>

namespace
{
using namespace sabot;

/** Aluminum 6061-T6, about. */
std::shared_ptr<const Material> metal()
{
  JohnsonCookParameters p;
  p.A = 324e6;
  p.B = 114e6;
  p.n = 0.42;
  p.C = 0.002;
  p.m = 1.34;
  p.melt_temperature = 925.;
  p.specific_heat = 896.;
  ElasticConstants constants;
  constants.density = 2700.;
  constants.young_modulus = 69e9;
  constants.poisson_ratio = 0.33;
  return std::make_shared<JohnsonCook>(constants, p);
}

/** Instructions of @p work, once it has been done @p before times, in a file
    of their own that bears @p name and the number of @p items. */
void count(const char *const name, const std::size_t items, const int before,
           const std::function<void()> &work)
{
  for (int i = 0; i < before; ++i)
    work();
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  work();
  char text[100];
  std::snprintf(text, sizeof(text), "%s, %zu items", name, items);
  CALLGRIND_DUMP_STATS_AT(text);
  CALLGRIND_STOP_INSTRUMENTATION;
}

/** A cube of cells that is compressed along one axis and flows. */
HexMesh cube(const int n, const double h)
{
  HexMesh mesh;
  const auto node = [n](const int i, const int j, const int k)
  { return GlobalIndex((k * (n + 1) + j) * (n + 1) + i); };
  constexpr int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        mesh.nodes.push_back({{i * h, j * h, k * h}});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        std::array<GlobalIndex, 8> cell;
        for (int a = 0; a < 8; ++a)
          cell[a] = node(i + corner[a][0], j + corner[a][1], k + corner[a][2]);
        mesh.cells.push_back(cell);
        mesh.volume.push_back(h * h * h);
      }
  return mesh;
}

void squeeze(Body &body, const double rate)
{
  NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Vec X = nodes.reference_position[i];
    nodes.velocity[i] = rate * vec(-X[0], 0.5 * X[1] + 0.1 * X[0], 0.5 * X[2]);
  }
}

/** Drift and forces: a step without what is around it. */
void step(Body &body, const double dt)
{
  NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    nodes.position[i] += dt * nodes.velocity[i];
  body.update_ghosts();
  body.compute_forces(0., dt);
}

void count_law()
{
  const auto law = metal();
  LawBatch points(*law);
  count("johnson-cook, plastic", LawBatch::n, 40,
        [&]() { law->update(points.batch); });
}

void count_fem_step(const char *const name, const double rate)
{
  constexpr int n = 10;
  FemBody body("block", 0, cube(n, 1e-3), metal(), FemOptions());
  body.distribute(std::vector<int>(body.partition_points().size(), 0),
                  MPI_COMM_WORLD);
  body.compute_forces(0., no_step);
  squeeze(body, rate);
  count(name, n * n * n, 40, [&]() { step(body, 5e-8); });
}

void count_spg()
{
  constexpr int n = 10;
  constexpr double h = 1e-3, edge = (n - 1) * h;
  SpgBody body("block", 0,
               make_box_cloud({{0., 0., 0.}}, {{edge, edge, edge}}, h), metal(),
               SpgOptions());
  body.distribute(std::vector<int>(n * n * n, 0), MPI_COMM_WORLD);
  body.compute_forces(0., no_step);
  squeeze(body, 1e4);
  count("spg step", n * n * n, 40, [&]() { step(body, 5e-8); });
  // Step 0 is a regular one, and it has strained by 2 %.
  count("kernel update", n * n * n, 0,
        [&]()
        {
          if (!body.update_topology(0, 0.))
            throw std::logic_error("no kernel update was due");
        });
}
} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  std::printf("compiler: %s\n", SABOT_COMPILER);
  count_law();
  count_fem_step("fem step, elastic", 1.);
  count_fem_step("fem step, plastic", 1e4);
  count_spg();
  MPI_Finalize();
}
