#ifndef sabot_base_nodal_state_h
#define sabot_base_nodal_state_h

#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
/**
 * The nodes of one body on this rank: owned ones first, ghosts after, each
 * group in ascending global order. One contiguous array per quantity; SI.
 */
struct NodalState
{
  std::size_t n_owned = 0;
  std::vector<GlobalIndex> global_id;    // [n_owned + n_ghost]
  AlignedVector<Vec> reference_position; // [n_owned + n_ghost]
  AlignedVector<Vec> position;           // [n_owned + n_ghost]
  AlignedVector<Vec> velocity;           // [n_owned + n_ghost]
  AlignedVector<Vec> force;              // [n_owned + n_ghost], owned used
  std::vector<double> lumped_mass;       // [n_owned + n_ghost]
  /** Mass that the integrator divides by: the lumped mass, plus what tied
      followers add; 0 for a follower, which the tie moves. */
  std::vector<double> inertia; // [n_owned + n_ghost]

  std::size_t size() const { return global_id.size(); }
  void resize(const std::size_t n)
  {
    global_id.resize(n);
    reference_position.resize(n);
    position.resize(n);
    velocity.resize(n);
    force.resize(n);
    lumped_mass.resize(n);
    inertia.resize(n);
  }
};
} // namespace sabot

#endif
