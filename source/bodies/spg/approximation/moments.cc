// Weights of bonds, moments of neighborhoods and the directions they lost.
#include "sabot/bodies/spg/approximation/approximation.h"

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/principal.h"

#include <algorithm>
#include <vector>

namespace sabot
{
namespace
{
/** Fraction of the intact middle eigenvalue of the moment matrix below which
    a direction counts as lost (doc/theory-spg.md). */
constexpr double lost_fraction = 0.15;
/** Fewer bonds than this never span space. */
constexpr std::size_t least_bonds = 4;
} // namespace

ParticleApproximation::ParticleApproximation(const SpgOptions &options)
    : functions(options.approximation), stores(options.stores_gradients()),
      has_tensor_kernel(options.has_tensor_kernel()), grows(options.grows)
{
}

void ParticleApproximation::allocate(const std::size_t n_owned)
{
  moment_inverse.resize(n_owned);
  lost_direction.resize(n_owned);
  spread.resize(n_owned);
}

void ParticleApproximation::extend(const std::size_t n_owned)
{
  allocate(n_owned);
  intact_eigenvalue.resize(n_owned, 0.);
  intact_spread.resize(n_owned, 0.);
}

void ParticleApproximation::update(BondList &bonds,
                                   const ParticleFields &fields,
                                   const LagrangianKernel &kernel,
                                   AlignedVector<Mat> *const second_derivatives)
{
  has_tensor_kernel ? find_moments<TensorKernel>(bonds, fields)
                    : find_moments<SphericalKernel>(bonds, fields);
  if (stores)
    find_gradients(bonds, fields, kernel, second_derivatives);
}

template <typename Kernel>
void ParticleApproximation::find_moments(BondList &bonds,
                                         const ParticleFields &fields)
{
  const bool intact = intact_eigenvalue.empty();
  const std::size_t n = moment_inverse.size();
  const AlignedVector<Mat> &kernel = fields.kernel;
  const Vec *const X = fields.kernel_reference_position.data();
  if (intact)
  {
    intact_eigenvalue.resize(n);
    intact_spread.resize(n);
  }
  std::vector<Mat> kernel_inverse(kernel.size());
  for (std::size_t i = 0; i < kernel.size(); ++i)
    kernel_inverse[i] = inverse(kernel[i]);
  for (std::size_t i = 0; i < n; ++i)
  {
    Mat M = Mat::zero();
    double sum = 0.;
    const Mat H_inverse = kernel_inverse[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = X[j] - X[i];
      const Vec xi = H_inverse * dX, xi_there = kernel_inverse[j] * dX;
      // As stored, which makes the functions exact for linear fields.
      const double w = bonds.weight[b] =
          0.5 * (Kernel::weight(xi) + Kernel::weight(xi_there));
      const double square = 0.5 * w * (norm_square(xi) + norm_square(xi_there));
      // Loose particles on an axis of symmetry may be pressed onto each other.
      const double distance_square = norm_square(dX);
      bonds.scaled_weight[b] =
          distance_square > 0. ? square / distance_square : 0.;
      sum += square;
      add_outer(M, w * xi, xi);
    }
    spread[i] = sum;
    if (intact || (!has_grown.empty() && has_grown[i]))
    {
      intact_eigenvalue[i] =
          std::max(intact_eigenvalue[i], middle_eigenvalue(M));
      intact_spread[i] = std::max(intact_spread[i], sum);
    }
    int n_damped = 3;
    const Mat inverse_moment =
        bonds.n_bonds(i) < least_bonds
            ? Mat::zero()
            : damped_inverse(M, lost_fraction * intact_eigenvalue[i], n_damped);
    moment_inverse[i] = transpose(H_inverse) * inverse_moment * H_inverse;
    // Nor is a crack that has opened healed before it closes: the pressure goes
    // by the volume, and would spring up.
    lost_direction[i] = n_damped > 0 || (lost_direction[i] &&
                                         fields.kernel_reference_volume[i] >
                                             fields.reference_volume[i]);
  }
  has_grown.clear();
}

void ParticleApproximation::visit_bonds(StateVisitor &visitor,
                                        const BondList &bonds)
{
  if (!stores)
    return;
  shape_gradient.resize(bonds.n_with_ghosts());
  visitor.visit("shape gradient", shape_gradient.data(), bonds.capacity(),
                sizeof(shape_gradient[0]));
  if (visitor.is_restoring())
    bonds.update_ghosts(shape_gradient.data());
}

void ParticleApproximation::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("moment inverse", moment_inverse);
  visitor.visit_array("weak", lost_direction);
  if (grows)
  {
    visitor.visit_array("intact eigenvalue", intact_eigenvalue);
    visitor.visit_array("intact spread", intact_spread);
  }
  visitor.visit_value("fallbacks", n_fallback);
}
} // namespace sabot
