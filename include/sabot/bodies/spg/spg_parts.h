#ifndef sabot_bodies_spg_spg_parts_h
#define sabot_bodies_spg_spg_parts_h

#include "sabot/base/types.h"
#include "sabot/bodies/material_points.h"

#include <cstddef>
#include <limits>
#include <string>

namespace sabot
{
class Approximation;
class BondFailure;
class BondList;
class GhostExchange;
class LagrangianKernel;
class ResidualStrength;
class SpgStableStep;
class VelocityConstraints;
struct NodalState;
struct ParticleFields;
struct SpgOptions;

/** Particles that go through the SPG step together; what they need stays in the
    first-level cache. */
constexpr std::size_t spg_batch_size = 64;
static_assert(spg_batch_size <= max_batch_points, "materials take no more");

/** Owned particles [begin, end) of one batch. */
struct ParticleRange
{
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

/** What the stages of the SPG step hand on, of one batch. */
struct StepWork : PointStepArrays<spg_batch_size>
{
  // Beside strain and spin increments, volume ratio, half of the mean volume
  // and viscous pressure (follow_motion) and what the return left (law):
  /** Square of the stabilization's stress [Pa^2]; see MaterialBatch. */
  double extra_square[spg_batch_size] = {};
  /** F_new F_old^-1 - 1: how the particle's neighborhood moves in this step,
      by which residuals and higher gradients follow. */
  Mat relative_gradient[spg_batch_size];
  /** F^-T of the incremental F: V sigma F^-T is the nominal stress by which
      forces act on the kernel's reference configuration. */
  Mat inverse_transpose[spg_batch_size];
};

/** What the SPG step finds out about all owned particles on the way. */
struct StepWatch
{
  double stable_step = std::numeric_limits<double>::max(); // [s]
  GlobalIndex stable_step_item = -1;                       // whose it is
  double largest_change =
      1.;              // largest stretch of F_inc or its inverse, squared
  std::string problem; // the first; empty: none

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
 */
struct SpgParts
{
  const std::string &name; // of the body, for messages
  const SpgOptions &options;
  /** Positions (with ghosts, up to date when forces are asked for), velocities,
      masses; forces of owned nodes are the step's result. */
  NodalState &nodes;
  const GhostExchange &exchange; // of particles
  BondList &bonds;        // neighbors of owned particles, symmetric weights
  ParticleFields &fields; // deformation and kernels
  MaterialPoints &points; // stress and state, one point a particle
  const LagrangianKernel &kernel;
  const Approximation &approximation; // moments or stored gradients
  BondFailure &failure;               // failed bonds and what they let go
  ResidualStrength &residual_strength;
  const SpgStableStep &stable_step;
  const VelocityConstraints &constraints;
  StepWork &work;
  StepWatch &watch;
};
} // namespace sabot

#endif
