// The smallest step of an SPG body: inertia for particles that ask for less.
#include "sabot/bodies/spg/spg_mass_scaling.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
SpgMassScaling::SpgMassScaling(const MassScalingOptions &options,
                               SpgParts &parts, SpgStableStep &stable,
                               Stabilization &stabilization,
                               MPI_Comm communicator)
    : MassScaling(options, parts.name, "particles", parts.nodes,
                  parts.constraints, communicator),
      parts(parts), stable(stable), stabilization(stabilization),
      communicator(communicator)
{
  parts.fields.own_step.resize(parts.nodes.n_owned);
}

bool SpgMassScaling::hold(const unsigned int step, const double dt)
{
  // Heavier particles may change what is left between bounds and frequencies;
  // measured anew, it shortens or lengthens all steps, so that mass may be due
  // once more. It is rarely more than once.
  constexpr int most = 4;
  bool changed = false;
  for (int pass = 0; pass < most && add_masses(dt); ++pass)
  {
    changed = true;
    if (!stable.calibration_is_due(parts, step, communicator))
      break;
    std::vector<double> &own = parts.fields.own_step;
    const std::vector<double> before(stable.data(), stable.data() + own.size());
    stable.calibrate(parts, stabilization, step, false, communicator);
    for (std::size_t i = 0; i < own.size(); ++i)
      own[i] *= stable.data()[i] / before[i];
    find_smallest_step();
  }
  return changed;
}

bool SpgMassScaling::add_masses(const double dt)
{
  const NodalState &nodes = parts.nodes;
  StableStep shortest;
  if (parts.watch.stable_step < smallest_step())
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      double &own = parts.fields.own_step[i];
      const double share = share_for(own);
      if (own < shortest.dt)
        shortest = {own, nodes.global_id[i]};
      if (!(share > 0.))
        continue;
      const double of_follower =
          nodes.is_follower(i) ? nodes.added_mass[i] : 0.;
      add(i, share * (nodes.moving_mass(i) + of_follower), dt);
      const double factor = std::sqrt(1. + share);
      stable.lengthen(i, factor);
      own *= factor;
    }
  const bool changed = settle(shortest);
  if (changed)
    find_smallest_step();
  return changed;
}

void SpgMassScaling::find_smallest_step()
{
  StepWatch &watch = parts.watch;
  watch.stable_step = StableStep().dt;
  watch.stable_step_item = -1;
  for (std::size_t i = 0; i < parts.nodes.n_owned; ++i)
    if (parts.fields.own_step[i] < watch.stable_step)
    {
      watch.stable_step = parts.fields.own_step[i];
      watch.stable_step_item = parts.nodes.global_id[i];
    }
}
} // namespace sabot
