#ifndef sabot_bodies_spg_motion_kernels_h
#define sabot_bodies_spg_motion_kernels_h

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/kernels/stress_update.h"
#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sabot
{
/**
 * The first stage of the SPG step, from positions to what the material and the
 * stabilization need, as kernels of one particle on plain values. They are
 * inlined into one loop over the batch (follow_motion()), which reads each
 * neighbor once.
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

/** F_inc = 1 + sum (dx - dX) (x) g of one particle; the linear field that
    the functions reproduce exactly. g = phi M^-1 dX with least squares,
    where M^-1 is taken out of the sum, F_inc = 1 + [sum phi (dx - dX) (x)
    dX] M^-1; else g is stored per bond. Without unit. Neighbors add up in
    the order of their global numbers, so that the bits do not depend on the
    number of ranks. A particle without bonds has F_inc = 1. Needs the
    positions of ghosts up to date. */
template <bool stored_gradients>
inline Mat incremental_deformation_gradient(const MotionViews &in,
                                            const std::size_t i)
{
  const Vec *const x = in.position, *const X = in.kernel_position;
  const std::uint32_t *const neighbor = in.bonds.neighbor.data();
  const double *const weight = in.bonds.weight.data();
  Mat A = Mat::zero();
  const Vec xi = x[i], Xi = X[i];
  const std::size_t last = in.bonds.end(i);
  for (std::size_t b = in.bonds.begin(i); b < last; ++b)
  {
    const std::uint32_t j = neighbor[b];
    const Vec dX = X[j] - Xi;
    if constexpr (stored_gradients)
      add_outer(A, x[j] - xi - dX, in.shape_gradient[b]);
    else
      add_outer(A, x[j] - xi - dX, weight[b] * dX);
  }
  if constexpr (!stored_gradients)
    A = A * in.moment_inverse[i];
  return Mat::identity() + A;
}

/** Strain and spin increments: symmetric and skew part of @p l, the
    increment of displacement by the position of the middle configuration. l
    is without unit; strains are tensor components in the order xx, yy, zz,
    xy, yz, xz, spins w_ij = (l_ij - l_ji)/2 for xy, yz, xz, both into place
    k of the batch. A rigid rotation below half a turn gives no strain
    (Hughes & Winget 1980). */
inline void split_increment(const Mat &l, const std::size_t k, StepWork &out)
{
  out.strain[0][k] = l(0, 0);
  out.strain[1][k] = l(1, 1);
  out.strain[2][k] = l(2, 2);
  out.strain[3][k] = 0.5 * (l(0, 1) + l(1, 0));
  out.strain[4][k] = 0.5 * (l(1, 2) + l(2, 1));
  out.strain[5][k] = 0.5 * (l(0, 2) + l(2, 0));
  out.spin[0][k] = 0.5 * (l(0, 1) - l(1, 0));
  out.spin[1][k] = 0.5 * (l(1, 2) - l(2, 1));
  out.spin[2][k] = 0.5 * (l(0, 2) - l(2, 0));
}

/** |A|^2 - 2: the square of the largest stretch where the other two are 1.
    |A|^2 is the sum of the squares of all three stretches, so this
    overestimates where the others are above 1 and falls short where they are
    below; 1 at rest and for rotations. Whoever divides by it takes at least
    1. */
inline double largest_stretch_square(const Mat &A)
{
  return norm_square(A.row[0]) + norm_square(A.row[1]) + norm_square(A.row[2]) -
         2.;
}

/** The stable step of the last kernel update, shortened by what has made the
    particle stiffer since: compression (by @p compression, the square of the
    largest inverse stretch) and the material. Frequencies go with the
    gradients of the functions, which F^-T turns into present ones:
    dt/sqrt(max(1, |F^-1|^2 - 2)), and with the root of the modulus:
    1/sqrt(max(1, stiffening)). Stretching does not lengthen the step. [s] */
inline double step_as_stiff_as_now(const MotionViews &in, const std::size_t i,
                                   const double compression)
{
  double step = in.stable_step[i] / std::sqrt(std::max(1., compression));
  if (in.stiffening != nullptr)
    step /= std::sqrt(std::max(1., in.stiffening[i]));
  return step;
}

/** What the body says of a particle whose incremental volume ratio @p
    jacobian is next to nothing: its name, number and place. Not in the loop.
    Throws nothing: other ranks wait in the exchanges of the step, after
    which SpgBody throws PhysicsError with this text. */
std::string describe_collapse(const MotionViews &in, const std::size_t i,
                              const double jacobian);

/** Keep the smallest step, the largest change and the first problem. A
    particle is a problem from J_inc <= 0.05 on, or where J is no number.
    largest_change is of F_inc and its inverse, squared; it calls for a
    kernel update at once. Of this rank's particles; who needs the worst of
    all ranks reduces it. */
inline void watch_particle(const MotionViews &in, const std::size_t i,
                           const double step, const double J,
                           const double compression, const double stretch,
                           StepWatch &watch)
{
  if (step < watch.stable_step)
  {
    watch.stable_step = step;
    watch.stable_step_item = in.global_id[i];
  }
  if (!(J > 0.05) && watch.problem.empty())
    watch.problem = describe_collapse(in, i, J);
  watch.largest_change = std::max({watch.largest_change, compression, stretch});
}

/**
 * Strain, spin, volumes, viscous pressure and F^-T of the particles of
 * @p range; their stable steps. Bulk viscosity is as for hexahedra; a flattened
 * particle's step tells its smallest dimension.
 *
 * Increments between F_old and F, both from X:
 *
 *   l = (F - F_old) [(F + F_old)/2]^-1,  d eps = sym l,  spin = skew l,
 *   J = det F V_ref/V_0,  V/2 = V_ref (J_inc + J_inc,old)/4  [m^3],
 *   q = rho h (c1 c |d| + c2 h d^2) where d = tr l/dt < 0    [Pa],
 *   h = min( (V_ref J_inc)^(1/3), 2 c dt_stable )            [m].
 *
 * The step [s] is the one of the last kernel update, as stiff as now, over 1 +
 * c1 (in compression) + h |l|/(c dt): the rate of deformation will have made
 * the particle stiffer by the end of the step. At dt = 0 nothing has moved: F
 * is that of the positions, and q that of the last step stays. Overwrites
 * F_inc; no communication.
 */
template <bool stored_gradients>
inline void follow_motion(const ParticleRange &range, const MotionViews &in,
                          StepWork &out, StepWatch &watch)
{
  const double c = in.sound_speed, dt = in.dt;
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const std::size_t k = i - range.begin;
    const Mat F = incremental_deformation_gradient<stored_gradients>(in, i);
    const Mat F_old = in.deformation_gradient[i];
    in.deformation_gradient[i] = F;
    const Mat l = (F - F_old) * inverse(0.5 * (F + F_old));
    double J, J_old;
    const Mat F_old_inverse = inverse(F_old, J_old);
    split_increment(l, k, out);
    out.relative_gradient[k] = (F - F_old) * F_old_inverse;
    const Mat F_inverse = inverse(F, J);
    out.inverse_transpose[k] = transpose(F_inverse);
    // F^-T is completed to a stress once that is known; its size also tells how
    // much stiffer compression has made the particle.
    const double V0 = in.reference_volume[i], V = in.kernel_reference_volume[i];
    out.jacobian[k] = V / V0 * J;
    out.half_volume[k] = 0.25 * V * (J + J_old);

    const double compression = largest_stretch_square(F_inverse);
    double step = step_as_stiff_as_now(in, i, compression);
    const double rate = is_step(dt) ? trace(l) / dt : 0.;
    const double h = std::min(std::cbrt(V * J), 2. * c * step);
    // Without a step that of the last one stays.
    out.viscous_pressure[k] = in.viscous_pressure[i];
    if (is_step(dt))
    {
      out.viscous_pressure[k] =
          bulk_viscosity_pressure(in.density * V0 / (V * J), c, h, rate,
                                  in.linear_viscosity, in.quadratic_viscosity);
      const double l_norm =
          std::sqrt(norm_square(l.row[0]) + norm_square(l.row[1]) +
                    norm_square(l.row[2]));
      // The bulk viscosity's damping ratio acts in compression only.
      step /=
          1. + (rate < 0. ? in.linear_viscosity : 0.) + h * l_norm / (c * dt);
    }
    out.step[k] = step;
    watch_particle(in, i, step, J, compression, largest_stretch_square(F),
                   watch);
  }
}
} // namespace sabot

#endif
