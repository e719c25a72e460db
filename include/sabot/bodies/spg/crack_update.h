#ifndef sabot_bodies_spg_crack_update_h
#define sabot_bodies_spg_crack_update_h

#include "sabot/bodies/spg/approximation/approximation.h"

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace sabot
{
class SpgStableStep;
class Stabilization;
struct CrackedParticles;
struct SpgParts;

/**
 * What follows bonds that fail while kernels stay as they are: the rows that
 * lose bonds get functions of those that are left, at the total F and volume of
 * before, and forces and steps beside them are found anew (doc/theory/spg.md,
 * Kernel update). X, kernels and all that is away from cracks stay.
 *
 * References to the rooms of a body, for one update.
 */
class CrackUpdate
{
public:
  CrackUpdate(SpgParts &body, ParticleApproximation &approximation,
              Stabilization &form, SpgStableStep &stable, MPI_Comm communicator)
      : body(body), approximation(approximation), form(form), stable(stable),
        communicator(communicator)
  {
  }

  /** Whether kernels may stay: not at regular updates and half way between
      them, under policies that search, with convex functions. */
  bool may_leave_kernels(const unsigned int step) const;
  /** What is left to do. */
  enum class Rest
  {
    nothing,
    all_forces, // a calibration has spent the stress, or the form has no other
    all_kernels // nothing is done: the functions that are left see too large a
                // change since the last update of kernels
  };
  /** By the marks of BondFailure::find(); positions are those of the last
      evaluation. Where nothing is left own forces are those of now, and what
      couplings have added to them is kept. Collective, the same on all ranks.
   */
  Rest update(const unsigned int step);

private:
  using Row = ParticleApproximation::CrackedRow;
  /** The part before steps and forces. @p left: of the functions of the marked
      rows. @return the owned particles of which something has changed.
      Collective. */
  std::vector<std::uint32_t> open(const std::vector<Row> &left);
  /** Bonds go from the marked rows, and their functions over to @p left. */
  void take_functions(const std::vector<Row> &left);
  /** @return false, and nothing is done, where the form evaluates all or
      nothing. Collective. */
  bool renew_forces(const CrackedParticles &cracked);

  SpgParts &body;
  ParticleApproximation &approximation;
  Stabilization &form;
  SpgStableStep &stable;
  MPI_Comm communicator;
};
} // namespace sabot

#endif
