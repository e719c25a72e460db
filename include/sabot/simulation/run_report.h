#ifndef sabot_simulation_run_report_h
#define sabot_simulation_run_report_h

#include "sabot/output/log.h"
#include "sabot/simulation/balance.h"
#include "sabot/simulation/scene.h"

#include <string>
#include <vector>

namespace sabot
{
/** How far a run is. */
struct RunProgress
{
  unsigned int step;
  double time, dt;               // [s]
  const std::string &limiter;    // of the step
  double wall, wall_since_start; // [s], with and without earlier parts
};

/**
 * What a run tells its log: where it comes from, what it is made of, how it
 * goes. log.txt is the record of a run, so it has what results must not have:
 * date, machine, command. Not collective unless said so; only the rank that
 * writes decides by the clock.
 */
class RunReport
{
public:
  /** All are kept by reference. */
  RunReport(const Scene &scene, const EnergyBalance &balance, Log &log)
      : scene(scene), balance(balance), log(log)
  {
  }

  /** Version and revision, title, date, machine, ranks, command, compiler and
      instruction set. */
  void describe_program(const int n_ranks) const;
  /** Sizes of bodies, notes, warnings, tied nodes,
      and how far nodes start inside of what they touch. Collective. */
  void describe_scene() const;
  /** The live line, and at each percent of the end time or minute of wall time
      a line of the record with the energies of the last row. */
  void progress(const RunProgress &now);

private:
  /** Step, time, step size with what limits it, energy residual, and the wall
      time left if the rest went as the past. */
  std::string progress_text(const RunProgress &now) const;
  /** Energies of the last row that are not zero [J]. */
  std::string energy_text() const;
  /** Of bodies that hold a smallest step; empty without. */
  std::string added_mass_text() const;

  const Scene &scene;
  const EnergyBalance &balance;
  Log &log;
  int said_percent = -1, said_minute = 0; // by the last line of the record
};
} // namespace sabot

#endif
