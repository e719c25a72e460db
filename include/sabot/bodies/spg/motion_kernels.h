#ifndef sabot_bodies_spg_motion_kernels_h
#define sabot_bodies_spg_motion_kernels_h

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/kernels/bond_pack.h"
#include "sabot/kernels/stress_update.h"
#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sabot
{
/**
 * The first stage of the SPG step, from positions to what the material and the
 * stabilization need (follow_motion()): sums over the bonds of each particle,
 * four bonds at once, then kinematics, four particles at once.
 *
 * All arrays belong to rooms of the body (SpgParts) and stay theirs;
 * motion_views() puts them together once per step. F_inc is from the
 * configuration X of the last kernel update to now; J_inc = det F_inc; volumes
 * are V = J_inc V_ref, the total volume ratio V/V_0.
 */
struct MotionViews
{
  // Owned particles and ghosts
  const Vec *position;        // x [m]
  const Vec *kernel_position; // X of the last kernel update [m]
  const GlobalIndex *global_id;
  // Bonds
  const BondList &bonds;
  const Vec *shape_gradient; // g, where gradients are stored [1/m]
  // Owned particles
  /** With lost directions damped, so that F_inc is the identity on them. */
  const Mat *moment_inverse;             // M^-1, for least squares [1/m^2]
  const double *reference_volume;        // V_0 [m^3]
  const double *kernel_reference_volume; // V_ref [m^3]
  const double *copies; // of them that make a whole; null: all are wholes
  /** With the calibration factor; what the motion adds comes in
      follow_motion(). */
  const double *stable_step; // at the last kernel update [s]
  /** Dilatational modulus over the one at rest, as of the last step. */
  const double *stiffening;       // null: the material never stiffens
  const double *viscous_pressure; // of the last step [Pa]
  Mat *deformation_gradient;      // F_inc, old in, new out
  // Constants of body and step
  double density, sound_speed; // [kg/m^3], [m/s]
  /** c1 and c2 of q = rho h (c1 c |d| + c2 h d^2), without unit. */
  double linear_viscosity, quadratic_viscosity;
  double dt; // [s], 0: nothing moves
  const std::string &body_name;
};

/** Sums over the bonds of particle @p i, into place @p k of the batch: of
    (dx - dX) (x) g', by rows, and of g', where g' = phi dX with least squares
    [m^2, m], from which M^-1 is taken out, else the stored g. Four bonds at
   once by their places in the row, which ascends by global number, so that the
   bits do not depend on the number of ranks. Needs the positions of ghosts up
   to date. */
template <bool stored_gradients>
inline void sum_over_bonds(const MotionViews &in, const std::size_t i,
                           const std::size_t k, StepWork &out)
{
  const Vec *const x = in.position, *const X = in.kernel_position;
  const std::uint32_t *const neighbor = in.bonds.neighbor.data();
  const float *const weight = in.bonds.weight.data();
  const Vec xi = x[i], Xi = X[i];
  Pack A[3][3] = {}, sum[3] = {};
  const std::size_t last = in.bonds.packed_end(i);
  for (std::size_t b = in.bonds.begin(i); b < last; b += n_lanes)
  {
    Pack dx[3], dX[3], g[3];
    gather(x, neighbor + b, dx);
    gather(X, neighbor + b, dX);
    for (int d = 0; d < 3; ++d)
    {
      dX[d] -= Xi[d];
      dx[d] = dx[d] - xi[d] - dX[d];
    }
    if constexpr (stored_gradients)
    {
      const std::uint32_t here[n_lanes] = {0, 1, 2, 3};
      gather(in.shape_gradient + b, here, g);
    }
    else
    {
      const Pack w = load_floats(weight + b);
      for (int d = 0; d < 3; ++d)
        g[d] = w * dX[d];
    }
    for (int c = 0; c < 3; ++c)
    {
      sum[c] += g[c];
      for (int d = 0; d < 3; ++d)
        A[d][c] += dx[d] * g[c];
    }
  }
  BondSums &sums = out.bond_sums[k];
  sums.lanes[0] = sum_lanes(A[0][0], A[0][1], A[0][2], A[1][0]);
  sums.lanes[1] = sum_lanes(A[1][1], A[1][2], A[2][0], A[2][1]);
  sums.lanes[2] = sum_lanes(A[2][2], sum[0], sum[1], sum[2]);
}

/** The matrices of four particles. Lanes of @p particle as of gather(). */
inline PackMat gather_matrices(const Mat *const matrices,
                               const std::uint32_t particle[n_lanes])
{
  PackMat out;
  const std::uint32_t row[n_lanes] = {3 * particle[0], 3 * particle[1],
                                      3 * particle[2], 3 * particle[3]};
  for (int d = 0; d < 3; ++d)
    gather(&matrices[0].row[d], row, out.m[d]);
  return out;
}

/** The first @p n of the matrices, to @p out; transposed with @p columns. */
template <bool columns>
inline void scatter_matrices(const PackMat &in, const std::size_t n,
                             Mat *const out)
{
  for (int d = 0; d < 3; ++d)
  {
    Vec lane[n_lanes];
    if (columns)
      unpack(in.m[0][d], in.m[1][d], in.m[2][d], lane);
    else
      unpack(in.m[d][0], in.m[d][1], in.m[d][2], lane);
    for (std::size_t l = 0; l < n; ++l)
      out[l].row[d] = lane[l];
  }
}

/** F_inc = 1 + sum (dx - dX) (x) g of four particles; the linear field that the
    functions reproduce exactly. g = phi M^-1 dX with least squares, where M^-1
    is taken out of the sum, F_inc = 1 + [sum phi (dx - dX) (x) dX] M^-1; else g
    is stored per bond. Without unit. A particle without bonds has F_inc = 1.
    @p sums: of the first particle of the four. */
template <bool stored_gradients>
inline PackMat
incremental_deformation_gradient(const MotionViews &in,
                                 const BondSums *const sums,
                                 const std::uint32_t particle[n_lanes])
{
  Pack part[3][4];
  for (int p = 0; p < 3; ++p)
  {
    for (std::size_t l = 0; l < n_lanes; ++l)
      part[p][l] = sums[l].lanes[p];
    transpose_lanes(part[p]);
  }
  PackMat A = {{{part[0][0], part[0][1], part[0][2]},
                {part[0][3], part[1][0], part[1][1]},
                {part[1][2], part[1][3], part[2][0]}}};
  if constexpr (!stored_gradients)
    A = multiply(A, gather_matrices(in.moment_inverse, particle));
  for (int d = 0; d < 3; ++d)
    A.m[d][d] += 1.;
  return A;
}

/** Strain and spin increments: symmetric and skew part of @p l, the
    increment of displacement by the position of the middle configuration. l
    is without unit; strains are tensor components in the order xx, yy, zz,
    xy, yz, xz, spins w_ij = (l_ij - l_ji)/2 for xy, yz, xz, both into places
    k to k + 3 of the batch. A rigid rotation below half a turn gives no strain
    (Hughes & Winget 1980). */
inline void split_increment(const PackMat &l, const std::size_t k,
                            StepWork &out)
{
  for (int d = 0; d < 3; ++d)
    store_pack(&out.strain[d][k], l.m[d][d]);
  constexpr int row[3] = {0, 1, 0}, column[3] = {1, 2, 2};
  for (int d = 0; d < 3; ++d)
  {
    const Pack upper = l.m[row[d]][column[d]], lower = l.m[column[d]][row[d]];
    store_pack(&out.strain[3 + d][k], 0.5 * (upper + lower));
    store_pack(&out.spin[d][k], 0.5 * (upper - lower));
  }
}

/** |A|^2 of each lane. */
inline Pack norm_square(const PackMat &a)
{
  Pack square = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      square += a.m[i][j] * a.m[i][j];
  return square;
}

/** |A|^2 - 2: the square of the largest stretch where the other two are 1.
    |A|^2 is the sum of the squares of all three stretches, so this
    overestimates where the others are above 1 and falls short where they are
    below; 1 at rest and for rotations. Whoever divides by it takes at least
    1. */
inline Pack largest_stretch_square(const PackMat &A)
{
  return norm_square(A) - 2.;
}

/** What the body says of a particle whose incremental volume ratio @p
    jacobian is next to nothing: its name, number and place. Not in the loop.
    Throws nothing: other ranks wait in the exchanges of the step, after
    which SpgBody throws PhysicsError with this text. */
std::string describe_collapse(const MotionViews &in, const std::size_t i,
                              const double jacobian);

/** Keep the smallest step and the first problem of the particles of @p range. A
    particle is a problem from J_inc <= 0.05 on, or where J is no number. Of
   this rank's particles; who needs the worst of all ranks reduces it. */
inline void watch_particles(const ParticleRange &range, const MotionViews &in,
                            const StepWork &work, StepWatch &watch)
{
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const std::size_t k = i - range.begin;
    if (work.step[k] < watch.stable_step)
    {
      watch.stable_step = work.step[k];
      watch.stable_step_item = in.global_id[i];
    }
    const double J = work.incremental_jacobian[k];
    if (!(J > 0.05) && watch.problem.empty())
      watch.problem = describe_collapse(in, i, J);
  }
}

/** Four numbers of particles. */
inline Pack gather_numbers(const double *const numbers,
                           const std::uint32_t particle[n_lanes])
{
  return Pack{numbers[particle[0]], numbers[particle[1]], numbers[particle[2]],
              numbers[particle[3]]};
}

/** The stable step of the last kernel update, shortened by what has made the
    particles stiffer since: compression (by @p compression, the square of the
    largest inverse stretch) and the material. Frequencies go with the
    gradients of the functions, which F^-T turns into present ones:
    dt/sqrt(max(1, |F^-1|^2 - 2)), and with the root of the modulus:
    1/sqrt(max(1, stiffening)). Stretching does not lengthen the step. [s] */
inline Pack step_as_stiff_as_now(const MotionViews &in,
                                 const std::uint32_t particle[n_lanes],
                                 const Pack compression)
{
  Pack stiffness = pack_max(compression, in_all(1.));
  if (in.stiffening != nullptr)
    stiffness *= pack_max(gather_numbers(in.stiffening, particle), in_all(1.));
  return gather_numbers(in.stable_step, particle) / pack_sqrt(stiffness);
}

/** Viscous pressure and stable step of four particles, into places k to k + 3;
    see follow_motion(). @p l: increment of the middle configuration, @p volume:
    present one [m^3], @p compression: as for step_as_stiff_as_now(). */
inline void find_viscosity_and_step(const MotionViews &in,
                                    const std::uint32_t particle[n_lanes],
                                    const PackMat &l, const Pack volume,
                                    const Pack compression, const std::size_t k,
                                    StepWork &out)
{
  const double c = in.sound_speed, dt = in.dt;
  Pack step = step_as_stiff_as_now(in, particle, compression);
  // Without a step that of the last one stays.
  Pack q = gather_numbers(in.viscous_pressure, particle);
  if (is_step(dt))
  {
    const Pack whole = in.copies == nullptr
                           ? volume
                           : gather_numbers(in.copies, particle) * volume;
    const Pack h = pack_min(pack_cbrt(whole), 2. * c * step),
               rate = (l.m[0][0] + l.m[1][1] + l.m[2][2]) / dt,
               closing = pack_max(-rate, Pack{}),
               density = in.density *
                         gather_numbers(in.reference_volume, particle) / volume;
    q = density * h * closing *
        (in.linear_viscosity * c + in.quadratic_viscosity * h * closing);
    // The bulk viscosity's damping ratio acts in compression only.
    step /= 1. + (rate < 0. ? in_all(in.linear_viscosity) : Pack{}) +
            h * pack_sqrt(norm_square(l)) / (c * dt);
  }
  store_pack(&out.viscous_pressure[k], q);
  store_pack(&out.step[k], step);
}

/** Kinematics of four particles from place @p k of the batch on, of which the
    first @p n are ones of their own; see follow_motion(). @return the largest
    of |F|^2 - 2 and |F^-1|^2 - 2 of each, which calls for a kernel update at
    once. */
template <bool stored_gradients>
inline Pack follow_four(const MotionViews &in,
                        const std::uint32_t particle[n_lanes],
                        const std::size_t k, const std::size_t n, StepWork &out)
{
  const PackMat F = incremental_deformation_gradient<stored_gradients>(
                    in, &out.bond_sums[k], particle),
                F_old = gather_matrices(in.deformation_gradient, particle);
  PackMat change, mean;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      change.m[i][j] = F.m[i][j] - F_old.m[i][j];
      mean.m[i][j] = 0.5 * (F.m[i][j] + F_old.m[i][j]);
    }
  scatter_matrices<false>(F, n, in.deformation_gradient + particle[0]);
  const auto inverse = [](const PackMat &a, const Pack J)
  {
    PackMat r = adjugate(a);
    const Pack factor = 1. / J;
    for (auto &row : r.m)
      for (Pack &entry : row)
        entry *= factor;
    return r;
  };
  const Pack J = determinant(F), J_old = determinant(F_old);
  const PackMat l = multiply(change, inverse(mean, determinant(mean))),
                F_inverse = inverse(F, J);
  split_increment(l, k, out);
  scatter_matrices<false>(multiply(change, inverse(F_old, J_old)), n_lanes,
                          out.relative_gradient + k);
  // F^-T is completed to a stress once that is known; its size also tells how
  // much stiffer compression has made the particle.
  scatter_matrices<true>(F_inverse, n_lanes, out.inverse_transpose + k);

  const Pack V = gather_numbers(in.kernel_reference_volume, particle);
  store_pack(&out.jacobian[k],
             V / gather_numbers(in.reference_volume, particle) * J);
  store_pack(&out.incremental_jacobian[k], J);
  store_pack(&out.half_volume[k], 0.25 * V * (J + J_old));
  const Pack compression = largest_stretch_square(F_inverse);
  find_viscosity_and_step(in, particle, l, V * J, compression, k, out);
  return pack_max(compression, largest_stretch_square(F));
}

/**
 * Strain, spin, volumes, viscous pressure and F^-T of the particles of
 * @p range; their stable steps. Bulk viscosity is as for hexahedra
 * (bulk_viscosity_pressure()); a flattened particle's step tells its smallest
 * dimension.
 *
 * Increments between F_old and F, both from X:
 *
 *   l = (F - F_old) [(F + F_old)/2]^-1,  d eps = sym l,  spin = skew l,
 *   J = det F V_ref/V_0,  V/2 = V_ref (J_inc + J_inc,old)/4  [m^3],
 *   q = rho h (c1 c |d| + c2 h d^2) where d = tr l/dt < 0    [Pa],
 *   h = min( (V_ref J_inc)^(1/3), 2 c dt_stable )            [m],
 *
 * V_ref in h that of the whole particle, on planes of symmetry, too.
 *
 * The step [s] is the one of the last kernel update, as stiff as now, over 1 +
 * c1 (in compression) + h |l|/(c dt): the rate of deformation will have made
 * the particle stiffer by the end of the step. At dt = 0 nothing has moved: F
 * is that of the positions, and q that of the last step stays. Overwrites
 * F_inc; no communication. The last particle stands in lanes that have none.
 */
template <bool stored_gradients>
inline void follow_motion(const ParticleRange &range, const MotionViews &in,
                          StepWork &out, StepWatch &watch)
{
  for (std::size_t i = range.begin; i < range.end; ++i)
    sum_over_bonds<stored_gradients>(in, i, i - range.begin, out);
  Pack change = in_all(watch.largest_change);
  for (std::size_t i = range.begin; i < range.end; i += n_lanes)
  {
    const std::size_t k = i - range.begin, n = std::min(n_lanes, range.end - i);
    std::uint32_t particle[n_lanes];
    for (std::size_t l = 0; l < n_lanes; ++l)
      particle[l] = i + std::min(l, n - 1);
    for (std::size_t l = n; l < n_lanes; ++l)
      out.bond_sums[k + l] = out.bond_sums[k + n - 1];
    change = pack_max(follow_four<stored_gradients>(in, particle, k, n, out),
                      change);
  }
  watch.largest_change = std::max({change[0], change[1], change[2], change[3]});
  watch_particles(range, in, out, watch);
}
} // namespace sabot

#endif
