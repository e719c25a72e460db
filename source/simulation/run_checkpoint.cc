// What a run saves in checkpoints, and how it goes on from them.
#include "sabot/simulation/run.h"

#include "sabot/base/error_report.h"

#include <cstdio>
#include <memory>

namespace sabot
{
double Run::seconds_since_start() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                       start_time)
      .count();
}

void Run::visit_state(StateVisitor &visitor, double &wall_seconds)
{
  stepper.visit_state(visitor);
  visitor.visit_value("smallest step", smallest_step);
  visitor.visit_text("limiter", limiter);
  visitor.visit_value("next check", next_check);
  for (std::size_t o = 0; o < scene.outputs.size(); ++o)
    scene.outputs[o]->visit_state(visitor, "next output " + std::to_string(o));
  for (const auto &quantity : scene.quantities)
    quantity->visit_state(visitor, "quantity " + quantity->name);
  balance.visit_state(visitor);
  forces.visit_state(visitor);
  control_shares.visit_state(visitor);
  step_shares.visit_state(visitor);
  visitor.visit_largest("wall seconds", wall_seconds);
  files.visit_state(visitor);
}

void Run::visit_all(StateVisitor &visitor, double &wall_seconds)
{
  visitor.section = "run";
  visit_state(visitor, wall_seconds);
  for (const auto &body : scene.bodies)
  {
    visitor.section = "body " + body->name;
    body->visit_state(visitor);
  }
  visitor.section = "substeps";
  stepper.visit_substeps(visitor);
  for (const auto &load : scene.loads)
  {
    visitor.section = "load " + load->name;
    load->visit_state(visitor);
  }
  for (const auto &coupling : scene.couplings)
  {
    visitor.section = "coupling " + coupling->name;
    coupling->visit_state(visitor);
  }
}

void Run::write_checkpoint(const std::string &name)
{
  const auto timer = timers.scope("checkpoint");
  CheckpointHeader header;
  header.version = version();
  header.parameters = scene.expanded_parameters();
  header.n_ranks = n_ranks;
  header.step = stepper.steps();
  header.time = stepper.time();
  // The same whenever the state is shown.
  const double wall_seconds = earlier_seconds + seconds_since_start();
  const auto visit = [&](StateVisitor &visitor)
  {
    double seconds = wall_seconds;
    visit_all(visitor, seconds);
  };
  std::size_t n_bytes = 0;
  within_memory("a checkpoint",
                [&]() { n_bytes = checkpoints.write(header, visit, name); });
  char text[200];
  std::snprintf(text, sizeof(text),
                "checkpoint at step %u, time %.4e s (%.1f MB)%s",
                stepper.steps(), stepper.time(), 1e-6 * n_bytes,
                name.empty() ? "" : (": " + name + ".h5").c_str());
  log.line(text);
}

void Run::restore(const std::string &checkpoint)
{
  int n_before = n_ranks;
  try
  {
    const auto file = std::make_shared<CheckpointFile>(checkpoint);
    n_before = file->n_ranks();
    StateRestorer restorer(file, rank, n_ranks);
    double wall_seconds = 0.;
    visit_all(restorer, wall_seconds);
    earlier_seconds = wall_seconds - seconds_since_start();
  }
  catch (const IOError &e)
  {
    // Other ranks may wait in a collective call: no way to go on together.
    if (n_ranks > 1)
    {
      std::fprintf(stderr, "error: %s\n", e.what());
      MPI_Abort(communicator, static_cast<int>(ExitCode::io_failed));
    }
    throw;
  }
  // The last row of the ledger, without a trace in what is compared later.
  balance.fill_row(stepper.time(), stepper.last_step());
  char text[200];
  std::snprintf(text, sizeof(text), "resumed at step %u, time %.6e s",
                stepper.steps(), stepper.time());
  log.line(text + (n_before == n_ranks
                       ? std::string()
                       : ", written on " + std::to_string(n_before) +
                             (n_before == 1 ? " rank" : " ranks")));
}
} // namespace sabot
