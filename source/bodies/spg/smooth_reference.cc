// Places of kernel updates without the sawtooth that functions do not see.
#include "sabot/bodies/spg/smooth_reference.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_options.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Pressure over the bulk modulus below which updates leave places as they are,
    and from which they take away all of the sawtooth. It was seen to grow from
    0.11 on, and not at 0.06. */
constexpr double low_pressure = 0.04, high_pressure = 0.08;
/** Each takes most of a sawtooth away, and of a wave of length l some (h/l)^2.
 */
constexpr int n_passes = 4;
/** No place moves by more than this part of the spacing: a sawtooth that drives
    itself has a few hundredths, and more is what strong curvature looks like.
 */
constexpr double farthest = 0.05;

/** Squares of stretches up to which neighbors still lie as in a lattice, so
   that who is off their middle is off his place. */
constexpr double largest_stretch = 2.25;

/** Whether a particle with the total gradient @p F is neither stretched nor
    flattened by more; |F|^2 - 2 bounds the largest stretch. */
bool is_nearly_lattice(const Mat &F)
{
  const auto square = [](const Mat &A)
  {
    return norm_square(A.row[0]) + norm_square(A.row[1]) +
           norm_square(A.row[2]);
  };
  return square(F) - 2. < largest_stretch &&
         square(inverse(F)) - 2. < largest_stretch;
}

/** What part of its sawtooth each owned particle loses. */
std::vector<double> parts_to_take(const SpgParts &body)
{
  const double K = body.points.law().bulk_modulus();
  const double *const xx = body.points.stress_row(0),
                      *const yy = body.points.stress_row(1),
                      *const zz = body.points.stress_row(2);
  std::vector<double> part(body.nodes.n_owned, 0.);
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    const double pressure = -(xx[i] + yy[i] + zz[i]) / 3.;
    if (pressure > low_pressure * K && !body.approximation.lost_direction[i] &&
        is_nearly_lattice(body.fields.deformation_gradient(i)))
      part[i] = std::min(1., (pressure / K - low_pressure) /
                                 (high_pressure - low_pressure));
  }
  return part;
}

/** Half of how far particle @p i at @p x is off the middle of its neighbors,
    beyond the linear field of the motion [m]. Of a sawtooth in a lattice that
   is its own part, where all neighbors have the opposite one. */
Vec off_the_middle(const SpgParts &body, const AlignedVector<Vec> &x,
                   const std::size_t i)
{
  const BondList &bonds = body.bonds;
  const AlignedVector<Vec> &X = body.fields.kernel_reference_position;
  const Mat F = body.fields.incremental_deformation_gradient[i];
  Vec sum = {};
  double all = 0.;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
  {
    const std::uint32_t j = bonds.neighbor[b];
    const double w = bonds.weight[b];
    sum += w * (x[j] - x[i] - F * (X[j] - X[i]));
    all += w;
  }
  return all > 0. ? -0.5 / all * sum : Vec{};
}
} // namespace

std::optional<AlignedVector<Vec>> find_sawtooth(const SpgParts &body,
                                                MPI_Comm communicator)
{
  if (body.options.stores_gradients())
    return std::nullopt;
  const std::vector<double> part = parts_to_take(body);
  int any = std::any_of(part.begin(), part.end(),
                        [](const double p) { return p > 0.; });
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (!any)
    return std::nullopt;
  const std::size_t n = body.nodes.n_owned;
  AlignedVector<Vec> sawtooth(n, Vec{}), more(n), x = body.nodes.position;
  for (int pass = 0; pass < n_passes; ++pass)
  {
    for (std::size_t i = 0; i < n; ++i)
      more[i] = part[i] > 0. ? part[i] * off_the_middle(body, x, i) : Vec{};
    body.exchange.hold(more.data());
    for (std::size_t i = 0; i < n; ++i)
    {
      sawtooth[i] += more[i];
      x[i] -= more[i];
    }
    body.exchange.update_positions(x.data());
  }
  for (std::size_t i = 0; i < n; ++i)
    sawtooth[i] *= std::min(1., farthest * body.kernel.local_spacing(i) /
                                    std::max(norm(sawtooth[i]), 1e-300));
  return sawtooth;
}

void settle_gradients(SpgParts &body)
{
  const Vec *const x = body.nodes.position.data(),
                   *const X = body.fields.kernel_reference_position.data();
  const BondList &bonds = body.bonds;
  ParticleFields &fields = body.fields;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    Mat change = Mat::zero();
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = X[j] - X[i];
      const double w = bonds.weight[b];
      add_outer(change, w * (x[j] - x[i] - dX), dX);
    }
    const Mat F =
        Mat::identity() + change * body.approximation.moment_inverse[i];
    const Mat back = inverse(F);
    fields.incremental_deformation_gradient[i] = F;
    fields.kernel_reference_deformation_gradient[i] =
        back * fields.kernel_reference_deformation_gradient[i];
    fields.kernel_reference_volume[i] /= determinant(F);
    // F takes it along at the next update: F H stays what it is.
    fields.kernel[i] = back * fields.kernel[i];
  }
  body.exchange.update(fields.kernel.data());
}
} // namespace sabot
