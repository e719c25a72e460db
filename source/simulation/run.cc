// The run of a scene, from set-up to result.
#include "sabot/simulation/run.h"
#include "sabot/simulation/found_zone.h"

#include "sabot/base/error_report.h"
#include "sabot/base/memory_limit.h"
#include "sabot/base/stop_signals.h"
#include "sabot/base/text.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/first_rank.h"
#include "sabot/simulation/plan.h"
#include "sabot/simulation/resume.h"
#include "sabot/simulation/run_quality.h"
#include "sabot/simulation/run_result.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace sabot
{
namespace
{
std::string format(const char *pattern, const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
  return text;
}

/** Steps to the next energy check and row of the histories: a hundredth of
    those made. So every run has some hundred rows, and they do not depend on
    its end, which may be put off later. */
unsigned int steps_to_next_check(const unsigned int steps)
{
  return std::max(1u, steps / 100);
}
} // namespace

std::string version()
{
  return SABOT_VERSION;
}

StepLimits step_limits(const RunSettings &settings)
{
  StepLimits limits;
  limits.factor = settings.step_factor;
  limits.largest = settings.largest_step;
  limits.end_time = settings.end_time;
  limits.most_substeps = settings.most_substeps;
  return limits;
}

Run::Run(Scene &scene, const std::string &folder, const bool quiet,
         MPI_Comm communicator)
    : scene(scene), communicator(communicator), log(quiet, communicator),
      stepper(scene.bodies, scene.loads, scene.couplings,
              step_limits(scene.settings), timers, communicator),
      balance(scene, communicator), forces(scene), report(scene, balance, log),
      control_shares(scene.bodies.size()), files(folder, communicator),
      checkpoints(folder + "/checkpoint", communicator,
                  scene.settings.ranks_per_checkpoint_file),
      schedule(scene.settings, communicator),
      step_shares(scene.bodies, scene.couplings, step_limits(scene.settings))
{
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  for (const auto &quantity : scene.quantities)
    quantity->attach(files.history);
}

ExitCode Run::execute(const std::string &checkpoint)
{
  start_time = std::chrono::steady_clock::now();
  std::string status = "completed", reason;
  ExitCode code = ExitCode::done;
  bool started = false;
  try
  {
    start(checkpoint);
    started = true;
    within_memory("the steps of the run", [&]() { loop(); });
    if (interrupted)
    {
      write_checkpoint();
      status = "interrupted";
      reason = signal_name(stop_signal()) + " asked the run to stop";
      code = ExitCode::interrupted;
    }
  }
  catch (const PhysicsError &e)
  {
    status = "failed";
    reason = e.what();
    code = ExitCode::physics_failed;
    log.line("");
    log.line("The run went wrong at time " + format("%.6e", stepper.time()) +
             " s, step " + std::to_string(stepper.steps()) + ": " + reason);
    // For inspection: what follows from it would go wrong again.
    if (started && !within_step)
      write_checkpoint("failed");
  }
  write_outputs(true);
  write_result(status, reason);
  return code;
}

void Run::open_folder(const bool append)
{
  on_first_rank(communicator, "write its output",
                [&]()
                {
                  files.keep_folder();
                  log.open(files.folder + "/log.txt", append);
                  // While the run goes on, nothing says that it is finished.
                  remove_file(files.folder + "/result.json");
                  write_text(
                      files.folder + "/parameters.prm",
                      parameters_file(version(), scene.expanded_parameters()));
                });
  for (const auto &output : scene.outputs)
    output->open(files);
}

void Run::start(const std::string &checkpoint)
{
  const bool resumed = !checkpoint.empty();
  open_folder(resumed);
  report.describe_program(n_ranks);
  const PhysicsPlan physics = plan_physics(scene);
  {
    const auto timer = timers.scope("set-up");
    within_memory("the parts of the ranks", [&]() { scene.distribute(); });
    give_back_memory();
    stop_early_when_asked(communicator);
    within_memory("the first forces", [&]() { stepper.initialize(); });
    step_shares.start(stepper.own_steps());
  }
  add_warnings(physics, scene);
  report.describe_scene();
  if (resumed)
    restore(checkpoint);
  else
  {
    checkpoints.clear();
    balance.start();
    forces.start(measure_bodies());
    record();
    write_outputs(false);
  }
  schedule.start(stepper.time());
}

bool Run::keeps_folders()
{
  constexpr std::chrono::seconds pause(1);
  const auto now = std::chrono::steady_clock::now();
  if (rank != 0 || now - last_look < pause)
    return true;
  last_look = now;
  return files.folder_trouble().empty() && checkpoints.trouble().empty();
}

bool Run::record_due() const
{
  for (const auto &output : scene.outputs)
    if (output->needs_rows() && output->is_due(stepper.time()))
      return true;
  return false;
}

void Run::make_step(const StepProposal &proposal)
{
  const double dt = stepper.choose(proposal);
  limiter = proposal.limiter;
  if (!(dt > 0.))
    throw PhysicsError("no stable step exists any more (limiter: " + limiter +
                       ")");
  // Where nothing but rigid bodies bounds it, only the scene's own bound
  // counts.
  const double stable = std::min(proposal.dt, scene.settings.largest_step);
  if (stable < 1e-4 * smallest_step && stepper.steps() > 10)
    throw PhysicsError(
        "the stable step collapsed from " + format("%.3e", smallest_step) +
        " s to " + format("%.3e", stable) + " s (limiter: " + limiter + ")");
  if (dt < scene.settings.end_time - stepper.time())
    smallest_step = std::min(smallest_step, stable);
  step_shares.look(proposal, dt, stepper.reaches_end(dt));
  const std::vector<unsigned int> counts = stepper.substeps(proposal, dt);
  if (stepper.is_cut(dt))
  {
    const double kick = balance.kick_energy(stepper.last_step());
    stepper.take(counts);
    balance.cut(kick, balance.kick_energy(dt));
  }
  within_step = true;
  stepper.advance(dt, counts);
  stepper.update();
  within_step = false;
}

void Run::loop()
{
  while (!stepper.is_finished())
  {
    const MessageCount before = messages_so_far();
    const StepProposal proposal =
        stepper.propose(stop_signal() != 0 || !keeps_folders());
    step_messages.sum.add(messages_so_far().since(before));
    if (proposal.interrupted)
    {
      interrupted = true;
      return;
    }
    if (scene.settings.checkpoint_at_end &&
        stepper.reaches_end(stepper.choose(proposal)))
      write_checkpoint();
    const MessageCount between = messages_so_far();
    make_step(proposal);
    step_messages.sum.add(messages_so_far().since(between));
    ++step_messages.steps;
    const bool check = stepper.steps() >= next_check || stepper.is_finished();
    const bool recorded = check || record_due();
    if (recorded)
    {
      next_check = stepper.steps() + steps_to_next_check(stepper.steps());
      const auto timer = timers.scope("balance");
      timer.count(items_of_rank());
      record();
    }
    if (!stepper.is_finished()) // else once, as the last
      write_outputs(false);
    report.progress({stepper.steps(), stepper.time(), stepper.last_step(),
                     limiter, earlier_seconds + seconds_since_start(),
                     seconds_since_start()});
    if (recorded)
    {
      balance.check(scene.settings.energy_limit, limiter);
      check_rigid_penetration(scene);
    }
    // The cut last step is no place to go on from.
    if (!stepper.is_finished() &&
        schedule.is_due(stepper.steps(), stepper.time(), seconds_since_start()))
      write_checkpoint();
  }
}

std::vector<double> Run::substeps() const
{
  std::vector<double> mean;
  for (const auto &body : scene.bodies)
    mean.push_back(stepper.mean_substeps(*body));
  return mean;
}

double Run::items_of_rank() const
{
  double items = 0.;
  for (const auto &body : scene.bodies)
    items += body->n_items();
  return items / n_ranks;
}

std::vector<BodyMeasures> Run::measure_bodies() const
{
  std::vector<BodyMeasures> measures;
  for (const auto &body : scene.bodies)
    measures.push_back(body->measure());
  return measures;
}

void Run::record()
{
  balance.look(stepper.time(), stepper.last_step());
  files.history.append("ledger", balance.row());
  const std::vector<BodyMeasures> measures = measure_bodies();
  for (const auto &body : scene.bodies)
  {
    Measures row = {{"time", "s", stepper.time()}};
    control_shares.look(body->id, measures[body->id]);
    const Measures columns = measures[body->id].columns();
    row.insert(row.end(), columns.begin(), columns.end());
    files.history.append(body->name, row);
  }
  forces.look(measures);
  forces.append(files.history, stepper.time());
  quantities_are_due = !scene.quantities.empty();
}

void Run::record_quantities()
{
  Measures row = {{"time", "s", stepper.time()}};
  for (const auto &quantity : scene.quantities)
  {
    quantity->look(stepper.time());
    row.push_back({quantity->name, quantity->unit(), quantity->value()});
  }
  files.history.append("quantities", row);
  quantities_are_due = false;
}

void Run::write_outputs(const bool is_last)
{
  const auto timer = timers.scope("output");
  OutputMoment moment{stepper.time(), stepper.steps(), is_last, {}};
  for (const auto &body : scene.bodies)
    moment.bodies.push_back(body.get());
  for (const auto &output : scene.outputs)
  {
    if (output->writes_fields() && (is_last || output->is_due(moment.time)))
      timer.count(items_of_rank());
    output->write_when_due(moment, files);
  }
  // Some are of the rows that gauges have just written.
  if (quantities_are_due)
    record_quantities();
  if (is_last && !files.history.tables.empty())
    files.write_history();
}

void Run::write_result(const std::string &status, const std::string &reason)
{
  const std::vector<ZoneVerdict> zones =
      judge_zones(scene, timers, stepper.steps(), communicator);
  const RunSummary summary{
      status,         reason,
      n_ranks,        stepper.steps(),
      stepper.time(), earlier_seconds + seconds_since_start(),
      smallest_step,  message_rates(step_messages, communicator),
      substeps()};
  const nlohmann::ordered_json result =
      make_result(scene, summary, balance, forces, control_shares, step_shares,
                  timers, zones, communicator);
  on_first_rank(
      communicator, "write its output",
      [&]()
      { write_text(files.folder + "/result.json", result.dump(2) + "\n"); });

  char text[200];
  std::snprintf(text, sizeof(text),
                "%s: %u steps to %.4e s in %.1f s; energy residual %.2e",
                status.c_str(), summary.steps, summary.time,
                summary.wall_seconds, balance.largest_residual());
  log.line(text);
  const std::string steps =
      describe_steps(step_shares, summary.steps, summary.time);
  if (!steps.empty())
    log.line("  " + steps);
  for (std::size_t b = 0; b < summary.substeps.size(); ++b)
    if (summary.substeps[b] > 1.)
      log.line("  body \"" + scene.bodies[b]->name + "\" made " +
               formatted("%.3g", summary.substeps[b]) +
               " steps within each of these (mean)");
  if (n_ranks > 1)
    log.line("  " + describe_messages(summary.messages));
  if (status != "failed")
    describe_residual(balance.largest_residual(), scene.settings, log);
  describe_quality(scene, control_shares, balance.energy_scale(), log);
  for (const ZoneVerdict &zone : zones)
    log.line("  " + describe(zone));
  for (const FoundZone &zone : find_grown(scene, communicator))
    log.line("  " + describe(zone));
  if (status == "failed" && !scene.quantities.empty())
    log.line("  quantities of a state that went wrong are not given");
  for (const auto &quantity : scene.quantities)
    if (status != "failed")
    {
      std::snprintf(text, sizeof(text), "  %s: %.6g %s", quantity->name.c_str(),
                    quantity->value(), quantity->unit().c_str());
      std::string line = text;
      for (const Measure &m : quantity->details())
        line += ", " + m.name + formatted(" %.6g ", m.value) + m.unit;
      log.line(line);
    }
}
} // namespace sabot
