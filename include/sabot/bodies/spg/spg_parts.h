#ifndef sabot_bodies_spg_spg_parts_h
#define sabot_bodies_spg_spg_parts_h

#include "sabot/base/types.h"
#include "sabot/bodies/material_points.h"
#include "sabot/kernels/pack.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <string>

namespace sabot
{
class ParticleApproximation;
class BondFailure;
class BondList;
class ParticleExchange;
class ImageReaction;
class LagrangianKernel;
class MirrorPlanes;
class ResidualStrength;
class SpgStableStep;
class VelocityConstraints;
struct NodalState;
struct ParticleFields;
struct SpgOptions;

/** Particles that go through the SPG step together; what they need stays in
    the first-level cache. The same for all forms, whose own scratch has this
    many places. */
constexpr std::size_t spg_batch_size = 64;
static_assert(spg_batch_size <= max_batch_points, "materials take no more");

/** Owned particles [begin, end) of one batch. Place k in the batch is
    particle begin + k. */
struct ParticleRange
{
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

/** Sums over the bonds of a particle as sum_over_bonds() leaves them. */
struct BondSums
{
  Pack lanes[3]; // the nine of a matrix by rows, then the three of a vector
  /** The vector. */
  Vec function_sum() const
  {
    return vec(lanes[2][1], lanes[2][2], lanes[2][3]);
  }
};

/** What the stages of the SPG step hand on, of one batch. One batch at a
    time, places 0 to range.size() - 1; nothing in it survives the batch. Not
    on the stack of the loop, so that alignment and address stay. */
struct StepWork : PointStepArrays<spg_batch_size>
{
  // Beside strain and spin increments, volume ratio, half of the mean volume
  // and viscous pressure (follow_motion) and what the return left (law):
  /** Square of the stabilization's stress [Pa^2]; see MaterialBatch. 3 tau^2
      in q^2 = 3/2 s : s + 3 tau^2 <= sigma_y^2, so that mean deviator and
      fluctuation share one yield condition (doc/theory/spg.md). */
  alignas(64) double extra_square[spg_batch_size] = {};
  /** F_new F_old^-1 - 1: how the particle's neighborhood moves in this step,
      by which residuals and higher gradients follow. In the frame of the
      last step; not symmetric. */
  Mat relative_gradient[spg_batch_size];
  /** F^-T of the incremental F: V sigma F^-T is the nominal stress by which
      forces act on the kernel's reference configuration. By rows; det F_inc
      is not in it. */
  Mat inverse_transpose[spg_batch_size];
  alignas(64) double step[spg_batch_size];     // stable one, as of now [s]
  double incremental_jacobian[spg_batch_size]; // det F_inc
  /** Of the first stage: (dx - dX) (x) g' and g', see sum_over_bonds(). The
      latter is what the particle's own stress acts on. */
  BondSums bond_sums[spg_batch_size];
};

/** What the SPG step finds out about all owned particles on the way. Of this
    rank only; whoever decides by it for the body reduces it over ranks. */
struct StepWatch
{
  double stable_step = std::numeric_limits<double>::max(); // [s]
  GlobalIndex stable_step_item = -1;                       // whose it is
  double largest_change =
      1.;                    // largest stretch of F_inc or its inverse, squared
  std::string problem;       // the first; empty: none
  std::size_t n_updates = 0; // of all kernels so far

  /** Before a step; the stable step and who limits it stay. */
  void restart()
  {
    largest_change = 1.;
    problem.clear();
  }
};

/**
 * The rooms of one SPG body, for what works on several of them: the step, the
 * forms of stabilization, the stable step. Valid while the body lives.
 *
 * References, not copies; what a function may change is what it gets without
 * const. No room knows the body itself.
 */
struct SpgParts
{
  const std::string &name; // of the body, for messages
  const SpgOptions &options;
  /** Positions (with ghosts, up to date when forces are asked for),
      velocities, masses; forces of owned nodes are the step's result.
      Ghosts' velocities and masses are those of the last renumbering only. */
  NodalState &nodes;
  const ParticleExchange &exchange; // of particles
  const MirrorPlanes &mirror;       // planes of symmetry with images
  /** Null of bodies without images. */
  const std::unique_ptr<ImageReaction> &reaction;
  BondList &bonds;        // neighbors of owned particles, symmetric weights
  ParticleFields &fields; // deformation and kernels
  MaterialPoints &points; // stress and state, one point a particle
  /** Spacings and support of the start, limits of the update. */
  const LagrangianKernel &kernel;
  const ParticleApproximation &approximation; // moments or stored gradients
  BondFailure &failure; // failed bonds and what they let go
  /** Rule for particles that lost a direction; has scratch space, so one a
      body. */
  ResidualStrength &residual_strength;
  const SpgStableStep &stable_step;
  VelocityConstraints &constraints;
  /** Scratch of the step, and what it has found out. */
  StepWork &work;
  StepWatch &watch;
};
} // namespace sabot

#endif
