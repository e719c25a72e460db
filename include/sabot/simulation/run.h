#ifndef sabot_simulation_run_h
#define sabot_simulation_run_h

#include "sabot/base/error.h"
#include "sabot/integrator/stepper.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/history.h"
#include "sabot/output/log.h"
#include "sabot/output/vtu_writer.h"
#include "sabot/simulation/scene.h"

#include <nlohmann/json.hpp>

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
  /** Energy balance of the moment, in J. */
  struct Balance
  {
    double total = 0., residual = 0.;
  };
  void start(const std::string &checkpoint);
  void open_folder(const bool append);
  void describe_scene();
  void set_initial_values();
  void loop();
  void record();
  void write_fields();
  void write_outputs(const bool all);
  void write_result(const std::string &status, const std::string &reason);
  void check_energy();
  Balance balance_energy();
  double momentum_residual() const;
  Measures quantities() const;
  std::string progress_text() const;
  nlohmann::ordered_json body_results() const;
  nlohmann::ordered_json timer_results() const;
  bool record_due() const;
  /** Numbers of the run itself: time, step, what is due next, histories. */
  void visit_state(StateVisitor &visitor);
  template <typename Visitor>
  void visit_all(Visitor &visitor);
  void write_checkpoint(const std::string &name = "");
  void restore(const std::string &checkpoint);
  bool checkpoint_due();
  double elapsed_seconds() const;

  Scene &scene;
  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
  Log log;
  Timers timers;
  Stepper stepper;
  History history;
  std::unique_ptr<VtuWriter> fields;

  unsigned int frame = 0;
  double smallest_step = std::numeric_limits<double>::max();
  std::string limiter;
  std::vector<double> next_output; // [s], per output of the scene
  double next_check = 0.;
  Measures ledger; // last row
  double initial_energy = 0., largest_energy = 0.;
  double last_residual = 0., largest_residual = 0.;
  std::array<double, 3> initial_momentum{};
  double momentum_scale = 0., largest_momentum_residual = 0.;
  std::chrono::steady_clock::time_point start_time;
  bool interrupted = false;
  std::unique_ptr<CheckpointFolder> checkpoints;
  std::string expanded_parameters;
  double earlier_seconds = 0.; // wall time before the run was resumed
  double next_checkpoint = 0., next_checkpoint_wall = 0.; // [s]
  bool within_step = false; // an error now leaves an unfinished step
};
} // namespace sabot

#endif
