#ifndef sabot_bodies_spg_spg_options_h
#define sabot_bodies_spg_spg_options_h

#include <array>
#include <cstdint>
#include <string>

namespace sabot
{
class Parameters;
}

namespace sabot
{
/** Settings of a smoothed-particle-Galerkin body; the defaults are argued in
    doc/theory-spg.md. */
struct SpgOptions
{
  enum class Approximation
  {
    least_squares,
    convex_exponential,
    convex_arctangent
  };
  enum class KernelShape
  {
    spherical,
    tensor
  };
  enum class Stabilization
  {
    bond_residual,
    second_gradient,
    velocity_smoothing,
    none
  };
  enum class NeighborPolicy
  {
    lagrangian,
    search_undamaged,
    search
  };
  enum class FailureCriterion
  {
    effective_plastic_strain,
    principal_stress,
    shear_strain
  };

  Approximation approximation = Approximation::least_squares;
  KernelShape kernel_shape = KernelShape::spherical;
  double normalized_support = 2.0; // kernel radius over spacing
  Stabilization stabilization = Stabilization::bond_residual;
  double stabilization_coefficient = 4.0; // alpha of the bond residual
  double smoothing_coefficient = 0.1;     // beta of the velocity smoothing
  unsigned int smoothing_interval = 5;    // steps
  NeighborPolicy neighbor_policy = NeighborPolicy::lagrangian;
  unsigned int kernel_update_interval = 30; // steps
  double kernel_update_strain = 0.02;       // since the last update
  double kernel_update_change = 1.1;        // stretch since the last update
  unsigned int failure_check_interval = 5;  // steps
  FailureCriterion failure_criterion =
      FailureCriterion::effective_plastic_strain;
  double critical_effective_plastic_strain = never;
  double critical_principal_stress = never_stress; // [Pa]
  double critical_shear_strain = never;
  double critical_stretch = 1.0;
  double bulk_viscosity_linear = 0.06;
  double bulk_viscosity_quadratic = 1.5;
  bool conducts_heat = false;
  double conduction_interval = 1e-6;                    // [s]
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  // Bits as in ParticleCloud::on_face
  std::uint32_t symmetry_faces = 0, clamped_faces = 0;

  static constexpr double never = 1e10;
  static constexpr double never_stress = 1e15; // [Pa]

  /** Critical value of the chosen criterion. */
  double critical_value() const;
  bool can_fail() const;

  static void declare_parameters(Parameters &prm);
  /** @p path: of the body, for messages. Throws InputError for combinations
      that do not fit together. */
  static SpgOptions parse(const Parameters &prm, const std::string &path);
};
} // namespace sabot

#endif
