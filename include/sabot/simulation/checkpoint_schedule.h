#ifndef sabot_simulation_checkpoint_schedule_h
#define sabot_simulation_checkpoint_schedule_h

#include "sabot/simulation/scene.h"

#include <mpi.h>

namespace sabot
{
/** When a run writes checkpoints: by steps, by physical time, by wall time. */
class CheckpointSchedule
{
public:
  CheckpointSchedule(const RunSettings &settings, MPI_Comm communicator)
      : settings(settings), communicator(communicator),
        next_wall(settings.checkpoint_wall_time)
  {
  }
  /** Go on after @p time [s]. */
  void start(const double time);
  /** Whether one is due after @p step steps, at @p time and after @p wall
      seconds of this run. Collective, the same on all ranks. */
  bool is_due(const unsigned int step, const double time, const double wall);

private:
  const RunSettings settings;
  MPI_Comm communicator;
  double next_time = 0., next_wall; // [s]
};
} // namespace sabot

#endif
