#ifndef sabot_simulation_run_h
#define sabot_simulation_run_h

#include "sabot/base/error.h"
#include "sabot/integrator/stepper.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/run_files.h"
#include "sabot/simulation/balance.h"
#include "sabot/simulation/checkpoint_schedule.h"
#include "sabot/simulation/control_shares.h"
#include "sabot/simulation/force_book.h"
#include "sabot/simulation/run_report.h"
#include "sabot/simulation/scene.h"
#include "sabot/simulation/step_shares.h"

#include <chrono>
#include <string>

namespace sabot
{
/**
 * Version of the program.
 * As in the project's CMakeLists.txt; it stands in result.json, parameters.prm,
 * the log and the headers of checkpoints.
 */
std::string version();

/**
 * Bounds of the step that a scene sets.
 * "Step factor", "Largest step" and "End time" of the scene [s]; the bound of
 * growth keeps its default.
 */
StepLimits step_limits(const RunSettings &settings);

/**
 * Runs a scene to its end and leaves its results in a folder: result.json,
 * history.h5, sabot.pvd with fields/, parameters.prm, log.txt, checkpoint/.
 */
class Run
{
public:
  /**
   * The scene must not be distributed yet: execute() does it. Makes the folder
   * of checkpoints and writes nothing else. With @p quiet the log keeps off the
   * screen, log.txt is filled in any case. @p scene is kept by reference and
   * must outlive the run. Collective.
   */
  Run(Scene &scene, const std::string &folder, const bool quiet,
      MPI_Comm communicator);

  /**
   * The whole run, or what is left of it after @p checkpoint (a file of this
   * scene and number of ranks); says what the process should return.
   * Collective.
   * Per step: propose, choose, advance, update; then, where due, a row of the
   * histories, outputs, the check of the energy balance and a checkpoint.
   * Stop signals (stop_signals.h) end it between two steps with a checkpoint
   * (ExitCode::interrupted), or StoppedEarly the set-up. A PhysicsError of any
   * rank ends it with status "failed", result and last output written, and a
   * checkpoint "failed.h5" where the state is of a whole step. InputError of
   * the set-up and IOError pass through to the caller.
   */
  ExitCode execute(const std::string &checkpoint = "");

private:
  /**
   * Folder, partition, initial forces; then the first row and outputs, or what
   * @p checkpoint holds. Older checkpoints in the folder are removed by a new
   * run.
   */
  void start(const std::string &checkpoint);
  /**
   * Rank 0 makes the folder, log.txt (appended to where @p append) and
   * parameters.prm with every entry; IOError on all ranks.
   */
  void open_folder(const bool append);
  /**
   * Until the end time or a signal. Energy is looked at with every row, and
   * after every hundredth of the steps made so far, which adds a row.
   */
  void loop();
  /**
   * PhysicsError where the step is not positive, or the stable step has fallen
   * below 1e-4 of the smallest one so far (after ten steps): then cells
   * collapse.
   */
  void make_step(const StepProposal &proposal);
  /**
   * Whether the folders of run and checkpoints are still there, looked at once
   * a second by rank 0; true on the others. Where not, the run stops like at a
   * signal, and saving its state tells what is wrong.
   */
  bool keeps_folders();
  /** Whether an output that reads the histories falls due now. */
  bool record_due() const;
  /** Mean over the steps of those that each body made within one. */
  std::vector<double> substeps() const;
  /** Particles and cells of all bodies over the number of ranks. */
  double items_of_rank() const;
  /** Of all bodies, by number. Collective. */
  std::vector<BodyMeasures> measure_bodies() const;
  /**
   * Balance and forces, then a row for the ledger, each body, forces and
   * impulses; that of the quantities follows once gauges have theirs.
   * Collective.
   */
  void record();
  void record_quantities();
  /** What is due, and with @p is_last all of it and history.h5; quantities of
      what has been recorded. Collective. */
  void write_outputs(const bool is_last);
  /**
   * Also judges the zones and says the last lines of the log. @p status:
   * "completed", "interrupted" or "failed". IOError on all ranks. Collective.
   */
  void write_result(const std::string &status, const std::string &reason);
  /** Numbers of the run itself, then of all bodies and couplings. */
  void visit_all(StateVisitor &visitor, double &wall_seconds);
  /** Stepper, limits met, due times, balance, histories, and the wall time of
      the run so far. */
  void visit_state(StateVisitor &visitor, double &wall_seconds);
  /** @p name: see CheckpointFolder::write(). Collective. */
  void write_checkpoint(const std::string &name = "");
  /**
   * Overwrites all state with what the file has of this rank's part of the
   * scene, whatever the number of ranks that wrote it. IOError where
   * they do not fit the scene; with more than one rank it ends the process
   * instead, as others may be waiting in a collective call.
   */
  void restore(const std::string &checkpoint);
  double seconds_since_start() const;

  Scene &scene;
  MPI_Comm communicator;
  int rank, n_ranks;
  Log log;
  Timers timers;
  Stepper stepper;
  EnergyBalance balance;
  ForceBook forces;
  RunReport report;
  ControlShares control_shares;
  RunFiles files;
  CheckpointFolder checkpoints;
  CheckpointSchedule schedule;
  StepShares step_shares;
  StepMessages step_messages;

  double smallest_step = std::numeric_limits<double>::max(); // stable [s]
  std::string limiter;
  unsigned int next_check = 0; // step
  std::chrono::steady_clock::time_point start_time, last_look;
  double earlier_seconds = 0.; // wall time before the run was resumed
  bool interrupted = false;
  bool within_step = false;        // an error now leaves an unfinished step
  bool quantities_are_due = false; // the bodies have been recorded, they not
};
} // namespace sabot

#endif
