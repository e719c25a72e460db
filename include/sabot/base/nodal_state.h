#ifndef sabot_base_nodal_state_h
#define sabot_base_nodal_state_h

#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
/**
 * The nodes of one body on this rank: owned ones first, ghosts after, each
 * group in ascending global order. One contiguous array per quantity; SI;
 * vectors in the fixed frame of the scene. The integrator, the couplings and
 * the output see a body's nodes through this alone, whatever it is made of.
 *
 * Ghosts are copies of nodes that another rank owns; the body fills position
 * and velocity of ghosts in update_ghosts(), the other arrays as it needs
 * them.
 */
struct NodalState
{
  std::size_t n_owned = 0;
  /** Of the ghosts the last ones: mirror images of particles beyond planes of
      symmetry, which only their body knows. */
  std::size_t n_images = 0;
  /** Number in the body, the same for every number of ranks. */
  std::vector<GlobalIndex> global_id; // [n_owned + n_ghost]
  /** X at the start of the run [m]; does not change. */
  AlignedVector<Vec> reference_position; // [n_owned + n_ghost]
  AlignedVector<Vec> position;           // [n_owned + n_ghost]
  /** At t(n) between steps, at t(n+1/2) within one [m/s]. */
  AlignedVector<Vec> velocity; // [n_owned + n_ghost]
  /** External - internal - stabilization, then with what couplings add: [N],
      of owned nodes. Ghosts' entries are not used. */
  AlignedVector<Vec> force; // [n_owned + n_ghost]
  /** What kicks have of the force beside it [N]: of a body that makes several
      steps within one of the scene, its own force acts along the shorter step,
      so that (1/n - 1) of it stands here. [n_owned], empty for all others. */
  AlignedVector<Vec> kick_change;
  /** Steps within the last one of the scene, the same on every rank; where they
      are several, velocity of owned nodes in the first of them [m/s]. */
  unsigned int n_substeps = 1;
  AlignedVector<Vec> first_velocity;
  /** Row sum of the mass matrix, or a particle's mass [kg]; constant but for
      erosion. Adds up to the body's mass. */
  std::vector<double> lumped_mass; // [n_owned + n_ghost]
  /** Mass that the integrator divides by [kg]: the lumped mass, plus what tied
      followers and mass scaling add; none for a follower, which the tie moves:
      ask is_follower(). */
  std::vector<double> inertia; // [n_owned + n_ghost]
  /** What mass scaling has added [kg], a follower's too; [n_owned], empty for
      a body without. */
  std::vector<double> added_mass;

  /** Whether a tie moves node @p i with its leaders; it has no inertia then. */
  bool is_follower(const std::size_t i) const { return !(inertia[i] > 0.); }
  /** Leave node @p i to a tie, which gives its mass to the leaders. */
  void make_follower(const std::size_t i) { inertia[i] = 0.; }
  /** Mass by which forces move node @p i, a follower's if it were free [kg]. */
  double moving_mass(const std::size_t i) const
  {
    return is_follower(i) ? lumped_mass[i] : inertia[i];
  }

  /** By which half a step of the scene kicks owned node @p i at its ends
      [N]. */
  Vec kick_force(const std::size_t i) const
  {
    return kick_change.empty() ? force[i] : force[i] + kick_change[i];
  }

  /** n_owned + n_ghost. */
  std::size_t size() const { return global_id.size(); }
  /**
   * Make room for @p n nodes; n_owned stays as it is.
   * New vectors are zero; the others stay as they are.
   */
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
