// Weights of bonds, moments of neighborhoods and the directions they lost.
#include "sabot/bodies/spg/approximation/approximation.h"

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/pack.h"
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

/** Bonds of one particle: offsets in space and in the space of the kernels of
    both ends, then weights, four at a time. Every row starts a pack of its own,
    so that the bits do not depend on what stands before it. */
template <typename Kernel>
class RowWeights
{
public:
  void start(const std::size_t n_bonds)
  {
    n = n_bonds;
    const std::size_t n_padded = (n + n_lanes - 1) / n_lanes * n_lanes;
    if (dX.size() < n_padded)
    {
      for (AlignedVector<Vec> *const offsets : {&dX, &here, &there})
        offsets->resize(n_padded);
      for (AlignedVector<double> *const values : {&weight, &scaled, &square})
        values->resize(n_padded);
    }
    // Lanes without a bond: any numbers that are never infinite.
    for (std::size_t b = n; b < n_padded; ++b)
      dX[b] = here[b] = there[b] = vec(1., 1., 1.);
  }
  void set(const std::size_t b, const Vec offset, const Mat &here_columns,
           const Mat &there_columns)
  {
    dX[b] = offset;
    here[b] = multiply_columns(here_columns, offset);
    there[b] = multiply_columns(there_columns, offset);
  }
  /** w, w mean |xi|^2/|dX|^2 and w mean |xi|^2 of all bonds. */
  void find()
  {
    const auto norm_square = [](const Pack v[3])
    { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    for (std::uint32_t b = 0; b < n; b += n_lanes)
    {
      const std::uint32_t lanes[n_lanes] = {b, b + 1, b + 2, b + 3};
      Pack xi[3], xi_there[3], offset[3];
      gather(here.data(), lanes, xi);
      gather(there.data(), lanes, xi_there);
      gather(dX.data(), lanes, offset);
      // As stored, which makes the functions exact for linear fields.
      const Pack w = to_double(to_float(
                     0.5 * (Kernel::weight(xi) + Kernel::weight(xi_there)))),
                 mean = 0.5 * w * (norm_square(xi) + norm_square(xi_there)),
                 distance = norm_square(offset);
      // Loose particles on an axis of symmetry may be pressed onto each other.
      const Pack one = {1., 1., 1., 1.}, zero = {};
      store_pack(&weight[b], w);
      store_pack(&square[b], mean);
      store_pack(&scaled[b], distance > 0.
                                 ? mean / (distance > 0. ? distance : one)
                                 : zero);
    }
  }

  AlignedVector<Vec> dX, here, there;           // [m], xi by both kernels
  AlignedVector<double> weight, scaled, square; // [-], [1/m^2], [-]

private:
  std::size_t n = 0;
};
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
  AlignedVector<Mat> to_kernel(kernel.size()); // H^-1 by columns
  for (std::size_t i = 0; i < kernel.size(); ++i)
    to_kernel[i] = transpose(inverse(kernel[i]));
  RowWeights<Kernel> row;
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t first = bonds.begin(i), n_bonds = bonds.n_bonds(i);
    const Mat here = to_kernel[i];
    row.start(n_bonds);
    for (std::size_t b = 0; b < n_bonds; ++b)
    {
      const std::uint32_t j = bonds.neighbor[first + b];
      row.set(b, X[j] - X[i], here, to_kernel[j]);
    }
    row.find();
    std::copy_n(row.weight.begin(), n_bonds, bonds.weight.begin() + first);
    std::copy_n(row.scaled.begin(), n_bonds,
                bonds.scaled_weight.begin() + first);
    Mat M = Mat::zero();
    double sum = 0.;
    for (std::size_t b = 0; b < n_bonds; ++b)
    {
      sum += row.square[b];
      add_outer(M, row.weight[b] * row.here[b], row.here[b]);
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
        n_bonds < least_bonds
            ? Mat::zero()
            : damped_inverse(M, lost_fraction * intact_eigenvalue[i], n_damped);
    moment_inverse[i] = here * inverse_moment * transpose(here);
    // Nor is a crack that has opened healed before it closes: the pressure goes
    // by the volume, and would spring up.
    lost_direction[i] = n_damped > 0 || (lost_direction[i] &&
                                         fields.kernel_reference_volume[i] >
                                             fields.reference_volume[i]);
  }
  has_grown.clear();
}

void ParticleApproximation::visit_bonds(StateVisitor &visitor,
                                        const BondList &bonds,
                                        const StateRows &rows)
{
  if (!stores)
    return;
  // Rows end in places of no bond, which stay zero.
  if (visitor.is_restoring())
    shape_gradient.assign(bonds.n_with_ghosts(), Vec{});
  visitor.visit_rows("shape gradient", shape_gradient.data(), bonds.capacity(),
                     rows);
  if (visitor.is_restoring())
    bonds.update_ghosts(shape_gradient.data());
}

void ParticleApproximation::visit_state(StateVisitor &visitor,
                                        const StateItems &items)
{
  visitor.visit_items("moment inverse", moment_inverse, items);
  visitor.visit_items("weak", lost_direction, items);
  if (grows)
  {
    visitor.visit_items("intact eigenvalue", intact_eigenvalue, items);
    visitor.visit_items("intact spread", intact_spread, items);
  }
  visitor.visit_count("fallbacks", n_fallback);
}
} // namespace sabot
