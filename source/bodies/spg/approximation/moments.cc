// Weights of bonds, moments of neighborhoods and the directions they lost.
#include "sabot/bodies/spg/approximation/approximation.h"

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/kernels/bond_pack.h"
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

/** Sums over the bonds of one particle, four at a time; xi are offsets in the
    space of its own kernel. */
struct MomentSums
{
  Pack moment[6] = {}; // w xi (x) xi: xx, yy, zz, xy, yz, xz
  Pack square = {};    // w mean |xi|^2

  void add(const Pack w, const Pack mean, const Pack xi[3])
  {
    const Pack weighted[3] = {w * xi[0], w * xi[1], w * xi[2]};
    for (int d = 0; d < 3; ++d)
    {
      moment[d] += weighted[d] * xi[d];
      moment[3 + d] += weighted[d == 1] * xi[d == 0 ? 1 : 2];
    }
    square += mean;
  }
  /** The moment, and in @p spread the sum of the squares. */
  Mat matrix(double &spread) const
  {
    const Pack zero = {},
               diagonal = sum_lanes(moment[0], moment[1], moment[2], square),
               mixed = sum_lanes(moment[3], moment[4], moment[5], zero);
    spread = diagonal[3];
    return {{vec(diagonal[0], mixed[0], mixed[2]),
             vec(mixed[0], diagonal[1], mixed[1]),
             vec(mixed[2], mixed[1], diagonal[2])}};
  }
};

/** One for both ends of a bond, whose weights must be the same to the bit. */
inline Pack dot(const Pack a[3], const Pack b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Weights of the bonds of particle @p i, and their sums. @p to_kernel: H^-1 of
    all particles. */
template <typename Kernel>
MomentSums weigh_bonds(BondList &bonds, const Vec *const X,
                       const Mat *const to_kernel, const std::size_t i)
{
  const Mat here = to_kernel[i];
  const Vec Xi = X[i];
  const Pack zero = {}, one = in_all(1.), places = {0., 1., 2., 3.};
  MomentSums sums;
  for (std::size_t b = bonds.begin(i), end = bonds.end(i); b < end;
       b += n_lanes)
  {
    const std::uint32_t *const j = &bonds.neighbor[b];
    Pack dX[3], xi[3], xi_there[3];
    gather(X, j, dX);
    for (int d = 0; d < 3; ++d)
      dX[d] -= Xi[d];
    for (std::uint32_t d = 0; d < 3; ++d)
    {
      const std::uint32_t row[n_lanes] = {3 * j[0] + d, 3 * j[1] + d,
                                          3 * j[2] + d, 3 * j[3] + d};
      Pack H[3];
      gather(to_kernel[0].row, row, H);
      xi_there[d] = dot(H, dX);
      const Pack of_here[3] = {in_all(here(d, 0)), in_all(here(d, 1)),
                               in_all(here(d, 2))};
      xi[d] = dot(of_here, dX);
    }
    // As stored, which makes the functions exact for linear fields; none in
    // places without a bond.
    const Pack phi = to_double(
        to_float(0.5 * (Kernel::weight(xi) + Kernel::weight(xi_there))));
    const Pack w = places < in_all(double(end - b)) ? phi : zero;
    const Pack mean = 0.5 * w * (dot(xi, xi) + dot(xi_there, xi_there)),
               distance = dot(dX, dX);
    sums.add(w, mean, xi);
    // Loose particles on an axis of symmetry may be pressed onto each other.
    const Pack scaled =
        distance > 0. ? mean / (distance > 0. ? distance : one) : zero;
    *reinterpret_cast<HalfPack *>(&bonds.weight[b]) = to_float(w);
    *reinterpret_cast<HalfPack *>(&bonds.scaled_weight[b]) = to_float(scaled);
  }
  return sums;
}
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
  AlignedVector<Mat> to_kernel(kernel.size()); // H^-1
  for (std::size_t i = 0; i < kernel.size(); ++i)
    to_kernel[i] = inverse(kernel[i]);
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t n_bonds = bonds.n_bonds(i);
    double sum;
    const Mat M =
        weigh_bonds<Kernel>(bonds, X, to_kernel.data(), i).matrix(sum);
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
    const Mat &here = to_kernel[i];
    moment_inverse[i] = transpose(here) * inverse_moment * here;
    // Nor is a crack that has opened healed before it closes: the pressure goes
    // by the volume, and would spring up.
    lost_direction[i] = n_damped > 0 || (lost_direction[i] &&
                                         fields.kernel_reference_volume[i] >
                                             fields.reference_volume[i]);
  }
  has_grown.clear();
}

ParticleApproximation::CrackedRow ParticleApproximation::without_bonds(
    const BondList &bonds, const ParticleFields &fields, const Vec *const x,
    const std::size_t i, const std::vector<char> &dead) const
{
  const Vec *const X = fields.kernel_reference_position.data();
  const Mat to_kernel = inverse(fields.kernel[i]);
  Mat moment = Mat::zero(), change = Mat::zero();
  CrackedRow row = {Mat::zero(), 0., true, Mat::identity()};
  std::size_t n_bonds = 0;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
  {
    if (dead[b])
      continue;
    const std::uint32_t j = bonds.neighbor[b];
    const double w = bonds.weight[b];
    const Vec dX = X[j] - X[i], xi = to_kernel * dX,
              xi_there = inverse(fields.kernel[j]) * dX;
    add_outer(moment, w * xi, xi);
    add_outer(change, w * (x[j] - x[i] - dX), dX);
    // Not of scaled weights, whose digits depend on the unit of length.
    row.spread += 0.5 * w * (norm_square(xi) + norm_square(xi_there));
    ++n_bonds;
  }
  int n_damped = 3;
  if (n_bonds >= least_bonds)
    row.moment_inverse =
        transpose(to_kernel) *
        damped_inverse(moment, lost_fraction * intact_eigenvalue[i], n_damped) *
        to_kernel;
  // What has been lost comes back at kernel updates only.
  row.is_lost = n_damped > 0 || lost_direction[i];
  row.gradient = Mat::identity() + change * row.moment_inverse;
  return row;
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
