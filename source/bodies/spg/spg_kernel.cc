#include "sabot/bodies/spg/spg_body.h"
#include "sabot/kernels/kernel_function.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Limits of the kernel's stretch, beyond those of 500 % shear: a kernel that
    moves with the material keeps its weights under any uniform deformation;
    the limits only catch degenerate particles. */
constexpr double least_stretch = 0.15, largest_stretch = 6.;
} // namespace

void SpgBody::set_up_kernel()
{
  const double support = options.normalized_support;
  for (Mat &H : kernel)
    H = {{vec(support * spacing[0], 0, 0), vec(0, support * spacing[1], 0),
          vec(0, 0, support * spacing[2])}};
  if (!is_regular)
  {
    std::copy(initial_kernel.begin(), initial_kernel.end(), kernel.begin());
    node_exchange.update(kernel.data());
  }
  kernel_position = nodal_state.position;
  previous_position = nodal_state.position;
  prepare_kernel();
  if (options.approximation != SpgOptions::Approximation::least_squares)
    set_convex_masses();
  estimate_stable_step();
  calibrate_stable_step();
}

void SpgBody::prepare_kernel()
{
  using Shape = SpgOptions::KernelShape;
  const bool spherical = options.kernel_shape == Shape::spherical;
  spherical ? compute_moments<SphericalKernel>()
            : compute_moments<TensorKernel>();
  if (options.approximation != SpgOptions::Approximation::least_squares)
    spherical ? compute_shape_gradients<SphericalKernel>()
              : compute_shape_gradients<TensorKernel>();
}

bool SpgBody::update_topology(const unsigned int step, const double time)
{
  // Regular updates where something has deformed; at once where a particle has
  // been stretched by much or a bond fails. All ranks must agree.
  const bool regular = step % options.kernel_update_interval == 0;
  double due = std::sqrt(largest_change) > options.kernel_update_change ||
               (regular && has_strained());
  if (step % options.failure_check_interval == 0 || regular)
    due = std::max(due, double(find_failed_bonds()));
  MPI_Allreduce(MPI_IN_PLACE, &due, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (due > 0.)
    update_kernel_and_forces(step);
  if (options.stabilization == Stabilization::velocity_smoothing &&
      step % options.smoothing_interval == 0)
    smooth_velocities();
  if (heat && time >= last_conduction + options.conduction_interval)
    conduct_heat(time);
  return due > 0.;
}

void SpgBody::update_kernel_and_forces(const std::size_t step)
{
  // The next step begins with half a kick by these forces, and the ledger will
  // count the work that the new bonds and functions do along it.
  const std::size_t n = nodal_state.n_owned;
  AlignedVector<Vec> added(n);
  for (std::size_t i = 0; i < n; ++i)
    added[i] = nodal_state.force[i] - own_force[i];
  update_kernel(step);
  std::string problem; // none where nothing is deformed yet
  evaluate_forces(0., problem);
  for (std::size_t i = 0; i < n; ++i)
    nodal_state.force[i] += added[i];
}

bool SpgBody::has_strained() const
{
  for (const Mat &F : gradient)
  {
    const Mat C = transpose(F) * F - Mat::identity();
    const double square =
        norm_square(C.row[0]) + norm_square(C.row[1]) + norm_square(C.row[2]);
    if (0.25 * square >=
        options.kernel_update_strain * options.kernel_update_strain)
      return true;
  }
  return false;
}

void SpgBody::update_kernel(const std::size_t step)
{
  const std::size_t n = nodal_state.n_owned;
  const Vec axes =
      options.normalized_support * vec(spacing[0], spacing[1], spacing[2]);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Mat F = gradient[i];
    total_gradient[i] = F * total_gradient[i];
    kernel_volume[i] *= determinant(F);
    kernel[i] = is_regular ? clamp_kernel(F * kernel[i], axes, least_stretch,
                                          largest_stretch)
                           : clamp_kernel(F * kernel[i], initial_kernel[i],
                                          least_stretch, largest_stretch);
    gradient[i] = Mat::identity();
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      bonds.residual[b] = store(residual_factor[i] * load(bonds.residual[b]));
    residual_factor[i] = 1.;
  }
  node_exchange.update(kernel.data());
  std::vector<double> held(n);
  for (std::size_t i = 0; i < n; ++i)
    held[i] = residual_energy(i);
  const std::vector<std::uint32_t> failed_before = n_failed;
  const std::vector<char> weak_before = weak;
  fail_bonds();
  if (options.neighbor_policy != SpgOptions::NeighborPolicy::lagrangian)
    search_neighbors();

  kernel_position = nodal_state.position;
  prepare_kernel();

  for (std::size_t i = 0; i < n; ++i)
  {
    // The linear part of the residual belongs to F, which starts anew.
    Mat A = Mat::zero();
    const Vec Xi = kernel_position[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      add_outer(A, bonds.weight[b] * load(bonds.residual[b]),
                kernel_position[bonds.neighbor[b]] - Xi);
    A = transpose(A * moment_inverse[i]);
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      bonds.residual[b] =
          store(load(bonds.residual[b]) -
                multiply_columns(A, kernel_position[bonds.neighbor[b]] - Xi));
    // Residuals that grew while they had no stiffness hold no energy.
    if (weak_before[i] && !weak[i])
      std::fill(bonds.residual.begin() + bonds.begin(i),
                bonds.residual.begin() + bonds.end(i), store(Vec{}));
    const bool became_weak = weak[i] && !weak_before[i];
    if (became_weak)
      release_tension(i);
    if (became_weak || n_failed[i] != failed_before[i])
      failure_loss[i] += held[i] - residual_energy(i);
  }
  if (second_gradient)
    second_gradient->restart();
  estimate_stable_step();
  ++n_updates;
  if (calibration_is_due(step))
  {
    last_calibration = step;
    calibrate_stable_step();
  }
}

template <typename Kernel>
void SpgBody::compute_moments()
{
  const bool intact = intact_eigenvalue.empty();
  const std::size_t n = nodal_state.n_owned;
  if (intact)
  {
    intact_eigenvalue.resize(n);
    intact_spread.resize(n);
  }
  std::vector<Mat> kernel_inverse(kernel.size());
  for (std::size_t i = 0; i < kernel.size(); ++i)
    kernel_inverse[i] = inverse(kernel[i]);
  const double mu = material->shear_modulus();
  const bool has_residuals =
      options.stabilization == Stabilization::bond_residual;
  for (std::size_t i = 0; i < n; ++i)
  {
    // The moment is judged in the undeformed shape of the kernel, where a
    // compressed but complete neighbourhood looks like an intact one.
    Mat M = Mat::zero();
    double spread = 0.;
    const Mat H_inverse = kernel_inverse[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = kernel_position[j] - kernel_position[i];
      const Vec xi = H_inverse * dX, xi_there = kernel_inverse[j] * dX;
      const double w = 0.5 * (Kernel::weight(xi) + Kernel::weight(xi_there));
      bonds.weight[b] = w;
      const double square = 0.5 * w * (norm_square(xi) + norm_square(xi_there));
      // Loose particles on an axis of symmetry may be pressed onto each other.
      const double distance_square = norm_square(dX);
      bonds.residual_weight[b] =
          distance_square > 0. ? square / distance_square : 0.;
      spread += square;
      add_outer(M, w * xi, xi);
    }
    if (intact)
    {
      intact_eigenvalue[i] = middle_eigenvalue(M);
      intact_spread[i] = spread;
    }
    int n_damped = 3;
    const Mat inverse_moment =
        bonds.n_bonds(i) < 4
            ? Mat::zero()
            : damped_inverse(M, lost_direction * intact_eigenvalue[i],
                             n_damped);
    moment_inverse[i] = transpose(H_inverse) * inverse_moment * H_inverse;
    // Nor is a crack that has opened healed before it closes: the pressure goes
    // by the volume, and would spring up.
    weak[i] =
        n_damped > 0 || (weak[i] && kernel_volume[i] > reference_volume[i]);
    const double S = std::max(spread, 0.5 * intact_spread[i]);
    bond_stiffness[i] =
        !has_residuals || weak[i] || S == 0.
            ? 0.
            : options.stabilization_coefficient * mu * kernel_volume[i] / S;
  }
}
} // namespace sabot
