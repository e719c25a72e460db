#ifndef sabot_simulation_run_result_h
#define sabot_simulation_run_result_h

#include "sabot/base/timers.h"
#include "sabot/simulation/balance.h"
#include "sabot/simulation/control_shares.h"
#include "sabot/simulation/force_book.h"
#include "sabot/simulation/step_shares.h"
#include "sabot/simulation/zone_verdict.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/**
 * How a run ended, for its result.
 * What only the run knows; the rest of the result is asked of bodies,
 * couplings, balance and timers. "completed", "interrupted" or "failed", and
 * for the latter two a reason in words. Wall time is summed over resumptions.
 */
struct RunSummary
{
  std::string status, reason; // "completed", ...; why not
  int n_ranks;
  unsigned int steps;
  double time, wall_seconds; // [s]
  /**
   * Before the step factor, over all steps but the last, which is cut to meet
   * the end time.
   */
  double smallest_step; // stable [s]; of no meaning without steps
  std::vector<MessageRates> messages;
  std::vector<double> substeps; // mean of each body, in the scene's order
};

/**
 * What result.json says of a run, in the order of the file. Collective.
 * In SI, keys with underscores. Sections: run, residuals, "bodies",
 * "quantities" (null after a failure), "energy" [J], "timers" (wall and
 * processor seconds of this rank, calls, items, processor time per item [ns]),
 * "step_limits", "messages_per_step" (and rank), "contact", "couplings",
 * "zone", "found_zones" where there are any, "knobs". Numbers that are not
 * finite become null, as JSON has none. Processor seconds and peak memory are
 * sums over ranks. The momentum residual is that of EnergyBalance, or that of
 * ForceBook where something holds a body from outside. Of fragments the twenty
 * heaviest stand in it.
 */
nlohmann::ordered_json
make_result(const Scene &scene, const RunSummary &summary,
            const EnergyBalance &balance, const ForceBook &forces,
            const ControlShares &shares, const StepShares &steps,
            const Timers &timers, const std::vector<ZoneVerdict> &zones,
            MPI_Comm communicator);
} // namespace sabot

#endif
