#ifndef sabot_simulation_run_h
#define sabot_simulation_run_h

#include "sabot/base/error.h"
#include "sabot/integrator/central_difference.h"
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

/**
 * Runs a scene to its end and leaves its results in a folder: result.json,
 * history.h5, sabot.pvd with fields/, parameters.prm, log.txt.
 */
class Run
{
public:
  Run(Scene &scene, const std::string &folder, const bool quiet,
      MPI_Comm communicator);

  /** The whole run; says what the process should return. Collective. */
  ExitCode execute();

private:
  /** Energy balance of the moment, in J. */
  struct Balance
  {
    double total = 0., residual = 0.;
  };
  void start();
  void loop();
  double next_step(const StepProposal &proposal) const;
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

  Scene &scene;
  const std::string folder;
  MPI_Comm communicator;
  int rank, n_ranks;
  Log log;
  Timers timers;
  CentralDifference integrator;
  History history;
  std::unique_ptr<VtuWriter> fields;

  unsigned int step = 0, frame = 0;
  double dt = 0., smallest_step = std::numeric_limits<double>::max();
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
};
} // namespace sabot

#endif
