#ifndef sabot_simulation_run_h
#define sabot_simulation_run_h

#include "sabot/base/error.h"
#include "sabot/integrator/stepper.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/log.h"
#include "sabot/output/run_files.h"
#include "sabot/simulation/balance.h"
#include "sabot/simulation/checkpoint_schedule.h"
#include "sabot/simulation/scene.h"

#include <chrono>
#include <string>

namespace sabot
{
/** Version of the program. */
std::string version();

/** Bounds of the step that a scene sets. */
StepLimits step_limits(const RunSettings &settings);

/**
 * Runs a scene to its end and leaves its results in a folder: result.json,
 * history.h5, sabot.pvd with fields/, parameters.prm, log.txt, checkpoint/.
 */
class Run
{
public:
  Run(Scene &scene, const std::string &folder, const bool quiet,
      MPI_Comm communicator);

  /** The whole run, or what is left of it after @p checkpoint (a file of this
      scene and number of ranks); says what the process should return.
      Collective. */
  ExitCode execute(const std::string &checkpoint = "");

private:
  void start(const std::string &checkpoint);
  void open_folder(const bool append);
  void describe_scene();
  void loop();
  void make_step(const StepProposal &proposal);
  bool record_due() const;
  void record();
  void write_outputs(const bool is_last);
  void write_result(const std::string &status, const std::string &reason);
  std::string progress_text() const;
  /** Numbers of the run itself, then of all bodies and couplings. */
  template <typename Visitor>
  void visit_all(Visitor &visitor);
  void visit_state(StateVisitor &visitor);
  void write_checkpoint(const std::string &name = "");
  void restore(const std::string &checkpoint);
  double seconds_since_start() const;

  Scene &scene;
  MPI_Comm communicator;
  int rank, n_ranks;
  Log log;
  Timers timers;
  Stepper stepper;
  Balance balance;
  RunFiles files;
  CheckpointFolder checkpoints;
  CheckpointSchedule schedule;

  double smallest_step = std::numeric_limits<double>::max(); // stable [s]
  std::string limiter;
  double next_check = 0.; // [s]
  std::chrono::steady_clock::time_point start_time;
  double earlier_seconds = 0.; // wall time before the run was resumed
  bool interrupted = false;
  bool within_step = false; // an error now leaves an unfinished step
};
} // namespace sabot

#endif
