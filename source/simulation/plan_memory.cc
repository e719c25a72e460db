// Where the memory of a scene goes: tables of bytes by array.
#include "sabot/base/memory_table.h"
#include "sabot/base/text.h"
#include "sabot/base/timers.h"
#include "sabot/bodies/memory_lists.h"
#include "sabot/integrator/stepper.h"
#include "sabot/simulation/plan.h"
#include "sabot/simulation/run.h"
#include "sabot/simulation/scene.h"

#include <sys/resource.h>

#include <algorithm>

namespace sabot
{
namespace
{
/** Rows of all ranks added up, the largest first; empty ones go. */
MemoryTable sum_over_ranks(MemoryTable table, MPI_Comm communicator)
{
  std::vector<double> bytes;
  for (const MemoryTable::Row &row : table.rows)
    bytes.push_back(row.bytes);
  MPI_Allreduce(MPI_IN_PLACE, bytes.data(), bytes.size(), MPI_DOUBLE, MPI_SUM,
                communicator);
  for (std::size_t r = 0; r < bytes.size(); ++r)
    table.rows[r].bytes = bytes[r];
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [](const MemoryTable::Row &a, const MemoryTable::Row &b)
                   { return a.bytes > b.bytes; });
  while (!table.rows.empty() && table.rows.back().bytes == 0.)
    table.rows.pop_back();
  return table;
}

std::string to_text(const Body &body, const MemoryTable &table)
{
  const double n = std::max<double>(1., body.n_items());
  std::string out =
      body.name + ": " + formatted("%.0f ", n) + body.item_name() +
      "\n\n| array | bytes per item | MB |\n| --- | --- | --- |\n";
  double sum = 0.;
  const auto add = [&](const std::string &name, const double bytes)
  {
    out += "| " + name + " | " + formatted("%.1f", bytes / n) + " | " +
           formatted("%.3f", 1e-6 * bytes) + " |\n";
  };
  for (const MemoryTable::Row &row : table.rows)
  {
    add(row.array, row.bytes);
    sum += row.bytes;
  }
  add("all", sum);
  return out + "\n";
}
} // namespace

std::string plan_memory(Scene &scene, MPI_Comm communicator)
{
  Timers timers;
  Stepper stepper(scene.bodies, scene.loads, scene.couplings,
                  step_limits(scene.settings), timers, communicator);
  scene.distribute();
  stepper.initialize();
  stepper.advance(stepper.choose(stepper.propose(false)));
  stepper.update();
  std::string out;
  for (const auto &body : scene.bodies)
    if (const MemoryView *const view = memory_view(*body))
    {
      MemoryTable table;
      view->list_memory(table);
      out += to_text(*body, sum_over_ranks(table, communicator));
    }
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  double peak = 1024. * usage.ru_maxrss;
  MPI_Allreduce(MPI_IN_PLACE, &peak, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return out + "Peak of the process so far: " + formatted("%.0f", 1e-6 * peak) +
         " MB, program and libraries included.\n";
}
} // namespace sabot
