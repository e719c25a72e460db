// What a run saves in checkpoints, and how it goes on from them.
#include "sabot/simulation/run.h"

#include "sabot/base/error_report.h"

#include <cstdio>

namespace sabot
{
double Run::seconds_since_start() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                       start_time)
      .count();
}

void Run::visit_state(StateVisitor &visitor)
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
  double seconds = earlier_seconds + seconds_since_start();
  visitor.visit_value("wall seconds", seconds);
  if (visitor.is_restoring())
    earlier_seconds = seconds - seconds_since_start();
  files.visit_state(visitor);
}

template <typename Visitor>
void Run::visit_all(Visitor &visitor)
{
  visitor.section = "run";
  visit_state(visitor);
  for (const auto &body : scene.bodies)
  {
    visitor.section = "body " + body->name;
    // The partition must be the one of the run that wrote it; ghosts follow
    // from the state of the body, and of one that grows the nodes, too.
    const bool grows = body->particle_sink() != nullptr;
    if (grows)
      body->visit_state(visitor);
    const auto &ids = body->nodes().global_id;
    const std::vector<GlobalIndex> owned(ids.begin(),
                                         ids.begin() + body->nodes().n_owned);
    std::vector<GlobalIndex> nodes = owned;
    visitor.visit_array("nodes", nodes);
    if (nodes != owned)
      throw IOError("the checkpoint does not fit: nodes of body \"" +
                    body->name + "\" are spread over the ranks otherwise");
    if (!grows)
      body->visit_state(visitor);
  }
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
  StateSaver saver;
  within_memory("a copy of the state for a checkpoint",
                [&]() { visit_all(saver); });
  const std::size_t n_bytes = checkpoints.write(header, saver.blocks, name);
  char text[200];
  std::snprintf(text, sizeof(text),
                "checkpoint at step %u, time %.4e s (%.1f MB)%s",
                stepper.steps(), stepper.time(), 1e-6 * n_bytes,
                name.empty() ? "" : (": " + name + ".h5").c_str());
  log.line(text);
}

void Run::restore(const std::string &checkpoint)
{
  try
  {
    StateRestorer restorer(CheckpointFolder::read(checkpoint, rank));
    visit_all(restorer);
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
  log.line(text);
}
} // namespace sabot
