#ifndef sabot_simulation_plan_output_h
#define sabot_simulation_plan_output_h

#include "sabot/simulation/plan.h"

namespace sabot
{
/** Rows of the histories, with those of the regular energy checks. */
double n_rows(const Scene &scene);

/** How large the outputs of a run become. Its functions are collective. */
class OutputEstimate
{
public:
  /** The scene as it is at the start. */
  OutputEstimate(const Scene &scene, const PhysicsPlan &physics,
                 MPI_Comm communicator);

  /**
   * Bytes that all outputs take: frames in which what the waves have reached
   * is full of numbers. How fast that grows is seen from the scene's state now,
   * at @p time [s]; rows of the histories by the steps of the run.
   */
  double bytes(const double time, const double n_steps) const;

private:
  struct BodyOutput
  {
    FieldSize size;
    std::vector<double> distances; // of nodes from where waves start [m]
    double wave_speed;             // [m/s]
  };
  const Scene &scene;
  MPI_Comm communicator;
  std::vector<BodyOutput> bodies;
};

/**
 * Wall time of all outputs of a run of @p n_steps [s]: frames and histories are
 * written as they are now to a temporary folder, rows of the histories are
 * made, and the medians count. Collective.
 */
double output_seconds(const Scene &scene, const double n_steps,
                      MPI_Comm communicator);
} // namespace sabot

#endif
