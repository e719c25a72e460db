#ifndef sabot_simulation_run_result_h
#define sabot_simulation_run_result_h

#include "sabot/base/timers.h"
#include "sabot/simulation/balance.h"
#include "sabot/simulation/zone_verdict.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/** How a run ended, for its result. */
struct RunSummary
{
  std::string status, reason; // "completed", ...; why not
  int n_ranks;
  unsigned int steps;
  double time, wall_seconds; // [s]
  double smallest_step;      // stable [s]; of no meaning without steps
};

/** What result.json says of a run, in the order of the file. Collective. */
nlohmann::ordered_json make_result(const Scene &scene,
                                   const RunSummary &summary,
                                   const Balance &balance, const Timers &timers,
                                   const std::vector<ZoneVerdict> &zones,
                                   MPI_Comm communicator);
} // namespace sabot

#endif
