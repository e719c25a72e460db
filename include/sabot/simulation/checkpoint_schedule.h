#ifndef sabot_simulation_checkpoint_schedule_h
#define sabot_simulation_checkpoint_schedule_h

#include "sabot/simulation/scene.h"

#include <mpi.h>

namespace sabot
{
/**
 * When a run writes checkpoints: by steps, by physical time, by wall time.
 * Each reason is off where its setting is 0; those that are on act side by
 * side.
 */
class CheckpointSchedule
{
public:
  /**
   * Settings are copied. The wall clock starts at 0 with the run, also a
   * resumed one.
   */
  CheckpointSchedule(const RunSettings &settings, MPI_Comm communicator)
      : settings(settings), communicator(communicator),
        next_wall(settings.checkpoint_wall_time)
  {
  }
  /**
   * Go on after @p time [s].
   * The next one by physical time falls due at the first multiple of the
   * interval after @p time, so that a resumed run writes when a straight one
   * does.
   */
  void start(const double time);
  /**
   * Whether one is due after @p step steps, at @p time and after @p wall
   * seconds of this run. Collective, the same on all ranks.
   * By wall time rank 0 decides, and is asked every sixteen steps only: clocks
   * differ between ranks. Times count as met from 1e-9 of the end time before.
   */
  bool is_due(const unsigned int step, const double time, const double wall);

private:
  const RunSettings settings;
  MPI_Comm communicator;
  double next_time = 0., next_wall; // [s]
};
} // namespace sabot

#endif
