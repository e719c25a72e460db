#ifndef sabot_bodies_spg_spg_options_h
#define sabot_bodies_spg_spg_options_h

#include "sabot/bodies/mass_scaling.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace sabot
{
class Parameters;

/**
 * Settings of a smoothed-particle-Galerkin body; the defaults are argued in
 * doc/theory-spg.md. What only one form of stabilization, one criterion or one
 * rule for failed metal knows stays in its own file: here are the choices, as
 * their registries made them.
 *
 * SI units. Everything is read before the body is made and does not change in a
 * run.
 */
struct SpgOptions
{
  /** First-order functions: linearly corrected (least squares), or
      generalized meshfree ones (Wu, Park & Chen 2011) with either basis.
      With least squares the unknowns are the positions of the particles.
      Convex functions do not interpolate: the unknowns are generalized
      positions, and masses are row sums (Wu & Wu 2018, Eq. 11). */
  enum class Approximation
  {
    least_squares,
    convex_exponential,
    convex_arctangent
  };
  /** Spline of the radius, or product of splines along the kernel's axes.
      Both of the cubic spline of Wu & Wu 2018, Eq. 18, in xi = H^-1 dX. */
  enum class KernelShape
  {
    spherical,
    tensor
  };
  /** Where bonds may come from after the start: nowhere, pairs of undamaged
      particles, all pairs but those that failed. No policy mends a bond that
      failed: that would be the self-healing that the paper excludes. */
  enum class NeighborPolicy
  {
    lagrangian,
    search_undamaged,
    search
  };

  /** Least squares, bond residual, bonds that never fail. */
  SpgOptions();

  Approximation approximation = Approximation::least_squares;
  KernelShape kernel_shape = KernelShape::spherical;
  /** At least 1.8 with spherical least squares, 1.2 with tensor kernels,
      1.05 with convex functions; parse() refuses less. */
  double normalized_support = 2.0; // kernel radius over spacing
  /** Makes the form of one body; each body calls it once. */
  Stabilization::Maker stabilization;
  NeighborPolicy neighbor_policy = NeighborPolicy::lagrangian;
  /** Three reasons for an update: at an interval where a particle's Green
      strain since the last update has reached kernel_update_strain; at once
      where one is stretched or flattened by kernel_update_change; whenever
      bonds fail. */
  unsigned int kernel_update_interval = 30; // steps
  double kernel_update_strain = 0.02;       // since the last update
  double kernel_update_change = 1.1;        // stretch since the last update
  unsigned int failure_check_interval = 5;  // steps
  /** Shared by copies of the options; has no state. */
  std::shared_ptr<const FailureCriterion> failure_criterion;
  /** |dx| over |dX at the start| that a bond must exceed to fail, beside the
      criterion; >= 1, so that none fails in compression. */
  double critical_stretch = 1.0;
  /** Over which the measure of failure is averaged [m]; none: it is local. */
  std::optional<double> nonlocal_length;
  ResidualStrength::Maker residual_strength;
  /** c1 and c2 of q = rho h (c1 c |d| + c2 h d^2) in compression. */
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  MassScalingOptions mass_scaling;
  bool conducts_heat = false;
  double conduction_interval = 1e-6;                    // [s]
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  /** Whether the body starts without particles and takes those that cells of
      its host turn into. */
  bool grows = false;
  // Bits as in ParticleCloud::on_face
  std::uint32_t symmetry_faces = 0, clamped_faces = 0;

  /** Whether particles store the gradients of their functions; least squares
      finds them from moments. That costs a vector per bond, and one per
      ghost's bond. */
  bool stores_gradients() const
  {
    return approximation != Approximation::least_squares;
  }
  bool has_tensor_kernel() const { return kernel_shape == KernelShape::tensor; }
  bool can_fail() const { return failure_criterion->can_be_met(); }
  /** Bonds fail by the effective plastic strain from @p critical on. For
      scenes made in code: the criterion is made by its registry from the
      exact text of the number. */
  void set_critical_plastic_strain(const double critical);

  static void declare_parameters(Parameters &prm);
  /** @p path: of the body, for messages. Throws InputError for combinations
      that do not fit together. These are: a support too small for the
      functions, second gradients without convex functions, entries of
      choices that were not made. Initial velocity and faces are the body's
      and are set by its discretization. */
  static SpgOptions parse(const Parameters &prm, const std::string &path);
};
} // namespace sabot

#endif
