#ifndef sabot_bodies_spg_stable_step_h
#define sabot_bodies_spg_stable_step_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"

#include <mpi.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace sabot
{
class Stabilization;
struct ParticleFields;
struct SpgParts;

/**
 * Stable step of each particle in the configuration of the last kernel update:
 * the Gershgorin bound of the largest eigenvalue of M^-1 K, with the row sums
 * of
 *
 *   K_IK = sum_N V_N rho c^2 g_NI g_NK + the stabilization's part,
 *
 * times a factor that says by how much the bound is too short. That factor is
 * measured on the whole body (Lanczos) and holds for particles whose bonds are
 * all there; the others keep the bound.
 *
 * Any eigenvalue of M^-1 K is at most the largest row sum of absolute values
 * over the mass (Gershgorin); each particle keeps its own row's 2/sqrt(row/m),
 * so that the log can say who limits the step. Longer neighborhoods make rows
 * longer but not frequencies higher, which is what the factor gives back: 2 to
 * 2.5 in an intact cloud.
 */
class SpgStableStep
{
public:
  void allocate(const std::size_t n_owned) { step.resize(n_owned); }
  /** Room for more particles; their bounds come with the next estimate(), and
      the next calibration counts as the first. */
  void extend(const std::size_t n_owned)
  {
    step.resize(n_owned);
    initial_factor = std::numeric_limits<double>::max();
  }

  /** Bound of each owned particle, with the present factor. Collective.
      2/sqrt(row sum/m) [s]; a particle without any stiffness gets two
      spacings over the wave speed. Particles with failed bonds get the bound
      without the factor. */
  void estimate(const SpgParts &body, const Stabilization &form);
  /** The same of the particles beside cracks only, whose bonds may be others
      than at the last update; all others keep their steps. Collective. */
  void estimate_beside_cracks(const SpgParts &body, const Stabilization &form);
  /** The same of particles @p beside some that have lost bonds since the last
      update [n_local]; the generalized stress stays. Collective. */
  void estimate_beside(const std::vector<char> &beside, const SpgParts &body,
                       const Stabilization &form);
  /** Before a kernel update: what has shortened steps since the last one stays
      in those that are not estimated anew, dt/sqrt(max(1, |F^-1|^2 - 2)) as
      within a step (step_as_stiff_as_now()). Local. */
  void carry(const ParticleFields &fields);
  /** Measure the factor anew. @p step_number: now; 0: the body's first, from
      which later factors may not go up. Collective. factor = 0.99
      sqrt(3)/(omega_max least bound), between 1 and that of the start,
      omega_max by 30 Lanczos iterations: steps end at omega dt = sqrt(3),
      the third-order resonance of central differences (Skeel, Zhang &
      Schlick 1997), not at 2. */
  void calibrate(const SpgParts &body, Stabilization &form,
                 const std::size_t step_number, const bool is_first,
                 MPI_Comm communicator);
  /** Whether the factor decides and the last calibration is old, or the bound
      itself has moved. Collective. Decides: an intact particle has the least
      bound of all. Old: 300 steps. Moved: that bound differs by 5 % from the
      least one of intact particles at the last calibration. */
  bool calibration_is_due(const SpgParts &body, const std::size_t step_number,
                          MPI_Comm communicator) const;

  bool is_calibrated() const
  {
    return initial_factor < std::numeric_limits<double>::max();
  }

  /** Owned particle @p i has become heavier: its step is @p factor times as
      long. */
  void lengthen(const std::size_t i, const double factor) { step[i] *= factor; }
  /** Stable steps of owned particles [s], before what the state adds. */
  const double *data() const { return step.data(); }

  void visit_state(StateVisitor &visitor, const StateItems &items);
  void list_memory(MemoryTable &table) const
  {
    table.add("stable steps", step);
  }

private:
  /** Least bounds [s], without the factor; the largest number for none. */
  struct Bounds
  {
    double intact, cracked;
  };
  Bounds least_bounds(const SpgParts &body, MPI_Comm communicator) const;
  void estimate(const SpgParts &body, const Stabilization &form,
                const std::vector<char> &wanted, const bool spends_stress);

  std::vector<double> step; // [s]
  double factor = 1.;       // proven part by which the bound is too short
  double initial_factor = std::numeric_limits<double>::max();
  std::size_t last_calibration = 0; // step
  double calibrated_bound = 0.; // least intact one, of the last calibration [s]
};

/** Largest frequency of the linearized body at rest [rad/s] by @p n Lanczos
    iterations on M^-1 K, from below: the Krylov space of the power
    iteration, of which it takes the best vector. The same on every number of
    ranks. Collective. In y = sqrt(m) v, from a start vector made of the
    particles' numbers; dot products are exact sums. */
double largest_frequency(const SpgParts &body, Stabilization &form,
                         const unsigned int n, MPI_Comm communicator);
} // namespace sabot

#endif
