#include "sabot/bodies/spg/spg_body.h"
#include "sabot/kernels/kernel_function.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void SpgBody::set_up_kernel()
{
  const double support = options.normalized_support;
  for (Mat &H : kernel)
    H = {{vec(support * spacing[0], 0, 0), vec(0, support * spacing[1], 0),
          vec(0, 0, support * spacing[2])}};
  kernel_position = nodal_state.position;
  compute_moments();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      bonds.rest[b] = kernel_position[bonds.neighbor[b]] - kernel_position[i];
  estimate_stable_step();
}

void SpgBody::update_topology(const unsigned int step, const double)
{
  // A particle that changed volume by half calls for an update, and so do
  // bonds that fail; all ranks must agree.
  double urgent = largest_change > 1.6;
  const bool regular = step % options.kernel_update_interval == 0;
  if (!regular && step % options.failure_check_interval == 0)
    urgent = std::max(urgent, double(find_failed_bonds()));
  if (!regular)
    MPI_Allreduce(MPI_IN_PLACE, &urgent, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (regular || urgent > 0.)
    update_kernel();
}

void SpgBody::update_kernel()
{
  const std::size_t n = nodal_state.n_owned;
  const Vec axes =
      options.normalized_support * vec(spacing[0], spacing[1], spacing[2]);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Mat F = gradient[i];
    total_gradient[i] = F * total_gradient[i];
    kernel_volume[i] *= determinant(F);
    kernel[i] = clamp_kernel(F * kernel[i], axes, 0.5, 2.);
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      bonds.rest[b] = F * bonds.rest[b];
    gradient[i] = Mat::identity();
  }
  node_exchange.update(kernel.data());
  n_removed_bonds += fail_bonds();

  kernel_position = nodal_state.position;
  compute_moments();

  for (std::size_t i = 0; i < n; ++i)
  {
    // The linear part of the residual belongs to F, which starts anew.
    Mat A = Mat::zero();
    const Vec Xi = kernel_position[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec dX = kernel_position[bonds.neighbor[b]] - Xi;
      add_outer(A, dX - bonds.rest[b], bonds.weight[b] * dX);
    }
    A = A * moment_inverse[i];
    double work = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec dX = kernel_position[bonds.neighbor[b]] - Xi;
      bonds.rest[b] += A * dX;
      work += dot(bonds.force[b], dX - bonds.rest[b]);
    }
    // The next step still starts with the forces of the old kernel.
    force_on_residual[i] = work;
  }
  estimate_stable_step();
}

bool SpgBody::find_failed_bonds()
{
  if (options.critical_effective_plastic_strain >= 1e10)
    return false;
  const std::size_t n = nodal_state.n_owned;
  const double *const eps = state_array("effective plastic strain");
  std::copy(eps, eps + n, plastic_strain_copy.begin());
  node_exchange.update(plastic_strain_copy.data());
  // Only bonds with a strained end can fail (their mean exceeds the limit).
  const double critical = options.critical_effective_plastic_strain,
               square = options.critical_stretch * options.critical_stretch;
  failed.assign(bonds.capacity(), 0);
  bool any = false;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      if (plastic_strain_copy[i] + plastic_strain_copy[j] <= 2. * critical)
        continue;
      const Vec now = nodal_state.position[j] - nodal_state.position[i],
                original = nodal_state.reference_position[j] -
                           nodal_state.reference_position[i];
      if (norm_square(now) > square * norm_square(original))
        failed[b] = any = true;
    }
  return any;
}

std::size_t SpgBody::fail_bonds()
{
  if (find_failed_bonds())
    for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        has_failed_bond[i] |= failed[b];
  else
    failed.assign(bonds.capacity(), 0);
  return bonds.remove(failed);
}

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
      const Vec xi = H_inverse * dX;
      const double w = 0.5 * (cubic_spline(norm(xi)) +
                              cubic_spline(norm(kernel_inverse[j] * dX)));
      bonds.weight[b] = w;
      spread += w * norm_square(dX);
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
    weak[i] = n_damped > 0;
    const double S = std::max(spread, 0.5 * intact_spread[i]);
    bond_stiffness[i] = weak[i] || S == 0. ? 0.
                                           : options.stabilization_coefficient *
                                                 mu * kernel_volume[i] / S;
  }
}

void SpgBody::estimate_stable_step()
{
  // Gershgorin bound of the largest eigenvalue of M^-1 K: row sums of
  // K_IK = sum_N V_N rho c^2 g_NI g_NK with |g_NJ| = phi |M_N^-1 dX|, and of
  // the bonds' springs.
  const std::size_t n = nodal_state.n_owned;
  const double c = material->sound_speed(),
               modulus = material->density() * c * c;
  AlignedVector<Mat> inverse_moment(nodal_state.size());
  struct Share
  {
    double gradient_sum, volume, stiffness;
  };
  std::vector<Share> share(nodal_state.size());
  for (std::size_t i = 0; i < n; ++i)
  {
    inverse_moment[i] = moment_inverse[i];
    double sum = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec g = bonds.weight[b] *
                    (moment_inverse[i] *
                     (kernel_position[bonds.neighbor[b]] - kernel_position[i]));
      self -= g;
      sum += norm(g);
    }
    share[i] = {sum + norm(self), kernel_volume[i], bond_stiffness[i]};
  }
  node_exchange.update(inverse_moment.data());
  node_exchange.update(share.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    double row = 0., springs = 0.;
    Vec self = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX =
          bonds.weight[b] * (kernel_position[j] - kernel_position[i]);
      row += share[j].volume * share[j].gradient_sum *
             norm(inverse_moment[j] * dX);
      self -= moment_inverse[i] * dX;
      springs +=
          2. * bonds.weight[b] * (share[i].stiffness + share[j].stiffness);
    }
    row += share[i].volume * share[i].gradient_sum * norm(self);
    const double mass = nodal_state.inertia[i] > 0.
                            ? nodal_state.inertia[i]
                            : nodal_state.lumped_mass[i];
    const double omega_square = (modulus * row + springs) / mass;
    update_stable_step[i] = omega_square > 0. ? 2. / std::sqrt(omega_square)
                                              : 2. * mean_spacing / c;
  }
}
} // namespace sabot
