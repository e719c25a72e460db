#include "sabot/simulation/run.h"

#include <cstdio>

namespace sabot
{
namespace
{
void visit_text(StateVisitor &visitor, const std::string &name,
                std::string &text)
{
  std::vector<char> characters(text.begin(), text.end());
  visitor.visit_resized(name, characters);
  text.assign(characters.begin(), characters.end());
}
} // namespace

double Run::elapsed_seconds() const
{
  return earlier_seconds + std::chrono::duration<double>(
                               std::chrono::steady_clock::now() - start_time)
                               .count();
}

void Run::visit_state(StateVisitor &visitor)
{
  stepper.visit_state(visitor);
  visitor.visit_value("smallest step", smallest_step);
  visit_text(visitor, "limiter", limiter);
  visitor.visit_value("frame", frame);
  visitor.visit_array("next output", next_output);
  visitor.visit_value("next check", next_check);
  visitor.visit_value("initial energy", initial_energy);
  visitor.visit_value("largest energy", largest_energy);
  visitor.visit_value("last residual", last_residual);
  visitor.visit_value("largest residual", largest_residual);
  visitor.visit_array("initial momentum", initial_momentum);
  visitor.visit_value("momentum scale", momentum_scale);
  visitor.visit_value("largest momentum residual", largest_momentum_residual);
  double seconds = elapsed_seconds();
  visitor.visit_value("wall seconds", seconds);
  if (visitor.is_restoring())
    earlier_seconds += seconds - elapsed_seconds();

  // The same on every rank, so that any rank can write them.
  std::string names;
  for (const auto &table : history.tables)
    names += table.first + "\n";
  visit_text(visitor, "tables", names);
  for (std::size_t begin = 0, end; begin < names.size(); begin = end + 1)
  {
    end = names.find('\n', begin);
    const std::string name = names.substr(begin, end - begin);
    History::Table &table = history.tables[name];
    std::string columns;
    for (const std::string &column : table.columns)
      columns += column + "\n";
    visit_text(visitor, name + " columns", columns);
    table.columns.clear();
    for (std::size_t first = 0, last; first < columns.size(); first = last + 1)
    {
      last = columns.find('\n', first);
      table.columns.push_back(columns.substr(first, last - first));
    }
    visitor.visit_resized(name + " values", table.values);
  }
  std::vector<std::pair<double, unsigned int>> frames;
  if (fields)
    frames = fields->frames;
  std::vector<double> frame_times;
  std::vector<unsigned int> frame_numbers;
  for (const auto &[time, number] : frames)
  {
    frame_times.push_back(time);
    frame_numbers.push_back(number);
  }
  visitor.visit_resized("frame times", frame_times);
  visitor.visit_resized("frame numbers", frame_numbers);
  if (visitor.is_restoring() && fields)
  {
    fields->frames.clear();
    for (std::size_t i = 0; i < frame_times.size(); ++i)
      fields->frames.emplace_back(frame_times[i], frame_numbers[i]);
  }
}

template <typename Visitor>
void Run::visit_all(Visitor &visitor)
{
  visitor.section = "run";
  visit_state(visitor);
  for (const auto &body : scene.bodies)
  {
    visitor.section = "body " + body->name;
    // The partition must be the one of the run that wrote it.
    std::vector<GlobalIndex> nodes = body->nodes().global_id;
    visitor.visit_array("nodes", nodes);
    if (nodes != body->nodes().global_id)
      throw IOError("the checkpoint does not fit: nodes of body \"" +
                    body->name + "\" are spread over the ranks otherwise");
    body->visit_state(visitor);
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
  header.parameters = expanded_parameters;
  header.n_ranks = n_ranks;
  header.step = stepper.steps();
  header.time = stepper.time();
  StateSaver saver;
  visit_all(saver);
  const std::size_t n_bytes = checkpoints->write(header, saver.blocks, name);
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
  const double largest = largest_energy;
  balance_energy();
  largest_energy = largest;
  char text[200];
  std::snprintf(text, sizeof(text), "resumed at step %u, time %.6e s",
                stepper.steps(), stepper.time());
  log.line(text);
}

bool Run::checkpoint_due()
{
  const RunSettings &s = scene.settings;
  bool due =
      s.checkpoint_steps > 0 && stepper.steps() % s.checkpoint_steps == 0;
  if (s.checkpoint_interval > 0. &&
      stepper.time() >= next_checkpoint - 1e-9 * s.end_time)
  {
    due = true;
    while (next_checkpoint - 1e-9 * s.end_time <= stepper.time())
      next_checkpoint += s.checkpoint_interval;
  }
  // Clocks differ between ranks: one decides, not too often.
  constexpr unsigned int steps_between_looks = 16;
  if (s.checkpoint_wall_time > 0. && stepper.steps() % steps_between_looks == 0)
  {
    const double now = std::chrono::duration<double>(
                           std::chrono::steady_clock::now() - start_time)
                           .count();
    int late = now >= next_checkpoint_wall;
    MPI_Bcast(&late, 1, MPI_INT, 0, communicator);
    if (late)
    {
      due = true;
      next_checkpoint_wall = now + s.checkpoint_wall_time;
    }
  }
  return due;
}
} // namespace sabot
