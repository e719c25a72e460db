#include "sabot/simulation/run.h"

#include "sabot/base/parameter_file.h"
#include "sabot/couplings/contact.h"
#include "sabot/output/file_tools.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <sstream>

namespace sabot
{
namespace
{
volatile std::sig_atomic_t asked_to_stop = 0;
void note_signal(int)
{
  asked_to_stop = 1;
}

std::string format(const char *pattern, const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
  return text;
}

/** How many energy checks and history rows a run makes at least. */
constexpr double checks_per_run = 200.;
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
  return limits;
}

Run::Run(Scene &scene, const std::string &folder, const bool quiet,
         MPI_Comm communicator)
    : scene(scene), folder(folder), communicator(communicator),
      log(quiet, communicator),
      stepper(scene.bodies, scene.couplings, step_limits(scene.settings),
              timers, communicator)
{
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
}

ExitCode Run::execute(const std::string &checkpoint)
{
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  start_time = std::chrono::steady_clock::now();
  std::string status = "completed", reason;
  ExitCode code = ExitCode::done;
  try
  {
    start(checkpoint);
    loop();
    if (interrupted)
    {
      write_checkpoint();
      status = "interrupted";
      reason = "a signal asked the run to stop";
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
    if (checkpoints && !within_step)
      write_checkpoint("failed");
  }
  write_outputs(true);
  write_result(status, reason);
  return code;
}

void Run::open_folder(const bool append)
{
  std::ostringstream text;
  print_expanded(scene.prm, text);
  expanded_parameters = text.str();
  std::string problem;
  if (rank == 0)
    try
    {
      make_folder(folder);
      log.open(folder + "/log.txt", append);
      write_text(folder + "/parameters.prm",
                 "# Sabot " + version() + "\n" + expanded_parameters);
    }
    catch (const IOError &e)
    {
      problem = e.what();
    }
  int bad = !problem.empty();
  MPI_Bcast(&bad, 1, MPI_INT, 0, communicator);
  if (bad)
    throw IOError(problem.empty() ? "rank 0 could not write its output"
                                  : problem);
  for (const OutputSettings &output : scene.outputs)
    if (output.type == OutputSettings::Type::vtu && !fields)
      fields = std::make_unique<VtuWriter>(folder, communicator);
  checkpoints =
      std::make_unique<CheckpointFolder>(folder + "/checkpoint", communicator);
}

void Run::describe_scene()
{
  for (const auto &body : scene.bodies)
    log.line("  body " + body->name + ": " + std::to_string(body->n_items()) +
             " " + body->item_name());
  for (const std::string &warning : scene.warnings)
    log.warning(warning);
  for (const auto &coupling : scene.couplings)
    for (const Measure &m : coupling->measure())
    {
      if (m.name == "tied nodes")
        log.line("  tie " + coupling->name + ": " + format("%.0f", m.value) +
                 " nodes");
      if (m.name == "initial penetration over spacing" && m.value > 0.)
        log.warning("contact " + coupling->name +
                    ": nodes start inside the other body by up to " +
                    format("%.3g", m.value) + " spacings");
    }
}

void Run::start(const std::string &checkpoint)
{
  const bool resumed = !checkpoint.empty();
  open_folder(resumed);
  log.line("Sabot " + version() + ", " + std::to_string(n_ranks) +
           (n_ranks == 1 ? " rank" : " ranks") +
           (scene.settings.title.empty() ? "" : ": " + scene.settings.title));
  {
    const auto timer = timers.scope("set-up");
    scene.distribute();
    stepper.initialize();
  }
  describe_scene();
  next_output.assign(scene.outputs.size(), 0.);
  next_checkpoint_wall = scene.settings.checkpoint_wall_time;
  if (resumed)
    restore(checkpoint);
  else
  {
    checkpoints->clear();
    set_initial_values();
    record();
    write_outputs(false);
  }
  if (scene.settings.checkpoint_interval > 0.)
    next_checkpoint =
        (std::floor(stepper.time() / scene.settings.checkpoint_interval *
                    (1. + 1e-12)) +
         1.) *
        scene.settings.checkpoint_interval;
}

void Run::set_initial_values()
{
  const Balance balance = balance_energy();
  initial_energy = balance.total;
  largest_energy = std::abs(balance.total);
  for (const auto &body : scene.bodies)
  {
    const BodyMeasures m = body->measure();
    momentum_scale += std::sqrt(2. * m.kinetic_energy * m.mass);
    for (int d = 0; d < 3; ++d)
      initial_momentum[d] += m.mass * m.velocity[d];
  }
}

bool Run::record_due() const
{
  const double slack = 1e-9 * scene.settings.end_time;
  for (std::size_t o = 0; o < scene.outputs.size(); ++o)
    if (scene.outputs[o].type == OutputSettings::Type::history &&
        stepper.time() >= next_output[o] - slack)
      return true;
  return false;
}

void Run::loop()
{
  while (!stepper.is_finished())
  {
    const StepProposal proposal = stepper.propose(asked_to_stop != 0);
    if (proposal.interrupted)
    {
      interrupted = true;
      return;
    }
    const double dt = stepper.choose(proposal);
    limiter = proposal.limiter;
    if (!(dt > 0.))
      throw PhysicsError("no stable step exists any more (limiter: " + limiter +
                         ")");
    if (proposal.dt < 1e-4 * smallest_step && stepper.steps() > 10)
      throw PhysicsError("the stable step collapsed from " +
                         format("%.3e", smallest_step) + " s to " +
                         format("%.3e", proposal.dt) +
                         " s (limiter: " + limiter + ")");
    if (dt < scene.settings.end_time - stepper.time())
      smallest_step = std::min(smallest_step, proposal.dt);
    within_step = true;
    stepper.advance(dt);
    stepper.update();
    within_step = false;
    const bool check = stepper.time() >= next_check || stepper.is_finished();
    const bool recorded = check || record_due();
    if (recorded)
    {
      next_check = stepper.time() + scene.settings.end_time / checks_per_run;
      const auto timer = timers.scope("balance");
      record();
    }
    write_outputs(false);
    log.progress(progress_text());
    if (recorded)
      check_energy();
    if (checkpoint_due())
      write_checkpoint();
  }
  log.progress(progress_text(), true);
}

Run::Balance Run::balance_energy()
{
  EnergyLedger e;
  for (const auto &body : scene.bodies)
    body->add_energies(e);
  for (const auto &coupling : scene.couplings)
    coupling->add_energies(e);
  e.reduce(communicator);
  Balance balance;
  balance.total = e.total().value();
  largest_energy = std::max(largest_energy, std::abs(balance.total));
  balance.residual =
      largest_energy > 0. && stepper.steps() > 0
          ? std::abs(balance.total - initial_energy) / largest_energy
          : 0.;
  ledger = {{"time", "s", stepper.time()},
            {"step size", "s", stepper.last_step()}};
  e.for_each(
      [&](const EnergyTerm &term, const double value) {
        ledger.push_back({term.name, "J", value});
      });
  ledger.push_back({"total", "J", balance.total});
  ledger.push_back({"residual", "1", balance.residual});
  return balance;
}

double Run::momentum_residual() const
{
  std::array<double, 3> change = {
      {-initial_momentum[0], -initial_momentum[1], -initial_momentum[2]}};
  for (const auto &body : scene.bodies)
  {
    const BodyMeasures measures = body->measure();
    for (int d = 0; d < 3; ++d)
      change[d] +=
          measures.mass * measures.velocity[d] + measures.eroded_momentum[d];
  }
  return momentum_scale > 0.
             ? std::sqrt(change[0] * change[0] + change[1] * change[1] +
                         change[2] * change[2]) /
                   momentum_scale
             : 0.;
}

void Run::record()
{
  const Balance balance = balance_energy();
  last_residual = balance.residual;
  largest_residual = std::max(largest_residual, balance.residual);
  if (std::isnan(balance.residual))
    largest_residual = balance.residual;
  if (scene.is_free)
    largest_momentum_residual =
        std::max(largest_momentum_residual, momentum_residual());
  history.append("ledger", ledger);
  for (const auto &body : scene.bodies)
  {
    Measures row = {{"time", "s", stepper.time()}};
    const Measures measures = body->measure().columns();
    row.insert(row.end(), measures.begin(), measures.end());
    history.append(body->name, row);
  }
  if (!scene.quantities.empty())
  {
    Measures row = {{"time", "s", stepper.time()}};
    const Measures values = quantities();
    row.insert(row.end(), values.begin(), values.end());
    history.append("quantities", row);
  }
}

void Run::check_energy()
{
  if (last_residual <= scene.settings.energy_limit)
    return;
  // Name the part that holds the surplus.
  const Measure *largest = nullptr;
  for (const Measure &m : ledger)
    if (m.unit == "J" && m.name != "total" && m.name != "plastic work" &&
        m.name != "failure" &&
        (largest == nullptr ||
         !(std::abs(m.value) <= std::abs(largest->value))))
      largest = &m;
  throw PhysicsError("the energy balance is off by " +
                     format("%.3g", 100. * last_residual) +
                     " %, more than the limit of " +
                     format("%.3g", 100. * scene.settings.energy_limit) +
                     " %; largest part: " + largest->name + " " +
                     format("%.6g", largest->value) +
                     " J; the step was limited by " + limiter);
}

Measures Run::quantities() const
{
  Measures values;
  for (const QuantityOfInterest &q : scene.quantities)
  {
    const BodyMeasures measures = scene.bodies[q.body]->measure();
    int axis = 0;
    for (int d = 1; d < 3; ++d)
      if (std::abs(q.direction[d]) > std::abs(q.direction[axis]))
        axis = d;
    const auto extent = [&](const int d)
    { return measures.high[d] - measures.low[d]; };
    using Type = QuantityOfInterest::Type;
    if (q.type == Type::velocity)
      values.push_back({q.name, "m/s",
                        q.direction[0] * measures.velocity[0] +
                            q.direction[1] * measures.velocity[1] +
                            q.direction[2] * measures.velocity[2]});
    else if (q.type == Type::length)
      values.push_back({q.name, "m", extent(axis)});
    else if (q.type == Type::radius)
    {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      values.push_back(
          {q.name, "m",
           0.25 * (q.whole[b] * extent(b) + q.whole[c] * extent(c))});
    }
    else
    {
      const double tip =
          q.direction[axis] > 0. ? measures.high[axis] : -measures.low[axis];
      values.push_back({q.name, "m", tip - q.origin});
    }
  }
  return values;
}

void Run::write_fields()
{
  const auto timer = timers.scope("output");
  std::vector<std::string> names;
  for (const auto &body : scene.bodies)
  {
    fields->write_body(body->name, body->output_mesh(), frame);
    names.push_back(body->name);
  }
  fields->add_time(stepper.time(), frame, names);
  ++frame;
}

void Run::write_outputs(const bool all)
{
  const double slack = 1e-9 * scene.settings.end_time;
  bool write_history = all && rank == 0;
  for (std::size_t o = 0; o < scene.outputs.size(); ++o)
  {
    const OutputSettings &output = scene.outputs[o];
    const bool is_vtu = output.type == OutputSettings::Type::vtu;
    const bool new_time = !fields || fields->frames.empty() ||
                          fields->frames.back().first != stepper.time();
    if (is_vtu && fields && new_time &&
        (all || stepper.time() >= next_output[o] - slack))
    {
      write_fields();
      write_history = rank == 0; // kept as far as the fields
    }
    while (next_output[o] - slack <= stepper.time())
      next_output[o] += output.interval;
  }
  int bad = 0;
  std::string problem;
  if (write_history && !history.tables.empty())
    try
    {
      history.write(folder + "/history.h5");
    }
    catch (const IOError &e)
    {
      problem = e.what();
      bad = 1;
    }
  if (all || (fields && !scene.outputs.empty()))
    MPI_Bcast(&bad, 1, MPI_INT, 0, communicator);
  if (bad)
    throw IOError(problem.empty() ? "rank 0 could not write its output"
                                  : problem);
}

std::string Run::progress_text() const
{
  const double wall = elapsed_seconds();
  const double done = stepper.time() / scene.settings.end_time;
  const double left = done > 0. ? wall * (1. - done) / done : 0.;
  char text[256];
  std::snprintf(text, sizeof(text),
                "step %6u  time %.4e s (%3.0f %%)  dt %.3e s (%s)  energy "
                "residual %.2e  ETA %.0f s",
                stepper.steps(), stepper.time(), 100. * done,
                stepper.last_step(), limiter.c_str(), last_residual, left);
  return text;
}
} // namespace sabot
