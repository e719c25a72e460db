// When checkpoints are due.
#include "sabot/simulation/checkpoint_schedule.h"

#include <cmath>

namespace sabot
{
void CheckpointSchedule::start(const double time)
{
  const double interval = settings.checkpoint_interval;
  if (interval > 0.)
    next_time = (std::floor(time / interval * (1. + 1e-12)) + 1.) * interval;
}

bool CheckpointSchedule::is_due(const unsigned int step, const double time,
                                const double wall)
{
  bool due =
      settings.checkpoint_steps > 0 && step % settings.checkpoint_steps == 0;
  // Of the interval: a later end time must not move what falls due.
  const double slack = 1e-9 * settings.checkpoint_interval;
  if (settings.checkpoint_interval > 0. && time >= next_time - slack)
  {
    due = true;
    while (next_time - slack <= time)
      next_time += settings.checkpoint_interval;
  }
  // Clocks differ between ranks: one decides, not too often.
  constexpr unsigned int steps_between_looks = 16;
  if (settings.checkpoint_wall_time > 0. && step % steps_between_looks == 0)
  {
    int late = wall >= next_wall;
    MPI_Bcast(&late, 1, MPI_INT, 0, communicator);
    if (late)
    {
      due = true;
      next_wall = wall + settings.checkpoint_wall_time;
    }
  }
  return due;
}
} // namespace sabot
