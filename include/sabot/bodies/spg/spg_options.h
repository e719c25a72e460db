#ifndef sabot_bodies_spg_spg_options_h
#define sabot_bodies_spg_spg_options_h

#include "sabot/bodies/spg/failure/failure_criterion.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace sabot
{
class Parameters;

/**
 * Settings of a smoothed-particle-Galerkin body; the defaults are argued in
 * doc/theory-spg.md. What only one form of stabilization, one criterion or one
 * rule for failed metal knows stays in its own file: here are the choices, as
 * their registries made them.
 */
struct SpgOptions
{
  /** First-order functions: linearly corrected (least squares), or generalized
      meshfree ones (Wu, Park & Chen 2011) with either basis. */
  enum class Approximation
  {
    least_squares,
    convex_exponential,
    convex_arctangent
  };
  /** Spline of the radius, or product of splines along the kernel's axes. */
  enum class KernelShape
  {
    spherical,
    tensor
  };
  /** Where bonds may come from after the start: nowhere, pairs of undamaged
      particles, all pairs but those that failed. */
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
  double normalized_support = 2.0; // kernel radius over spacing
  Stabilization::Maker stabilization;
  NeighborPolicy neighbor_policy = NeighborPolicy::lagrangian;
  unsigned int kernel_update_interval = 30; // steps
  double kernel_update_strain = 0.02;       // since the last update
  double kernel_update_change = 1.1;        // stretch since the last update
  unsigned int failure_check_interval = 5;  // steps
  std::shared_ptr<const FailureCriterion> failure_criterion;
  double critical_stretch = 1.0;
  ResidualStrength::Maker residual_strength;
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  bool conducts_heat = false;
  double conduction_interval = 1e-6;                    // [s]
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  // Bits as in ParticleCloud::on_face
  std::uint32_t symmetry_faces = 0, clamped_faces = 0;

  /** Whether particles store the gradients of their functions; least squares
      finds them from moments. */
  bool stores_gradients() const
  {
    return approximation != Approximation::least_squares;
  }
  bool has_tensor_kernel() const { return kernel_shape == KernelShape::tensor; }
  bool can_fail() const { return failure_criterion->can_be_met(); }
  /** Bonds fail by the effective plastic strain from @p critical on. */
  void set_critical_plastic_strain(const double critical);

  static void declare_parameters(Parameters &prm);
  /** @p path: of the body, for messages. Throws InputError for combinations
      that do not fit together. */
  static SpgOptions parse(const Parameters &prm, const std::string &path);
};
} // namespace sabot

#endif
