#ifndef sabot_bodies_fem_cell_kernels_h
#define sabot_bodies_fem_cell_kernels_h

#include "sabot/kernels/pack.h"

#include <algorithm>
#include <cmath>

/**
 * Kernels of four hexahedra, or of four points of one, that all integration
 * rules share. Always inlined: they are steps of one loop, and a call between
 * them would cost more than they do.
 */
#define SABOT_IN_LOOP __attribute__((always_inline)) inline

namespace sabot
{
/** What the kernels need of a body's material at rest and of its options:
    read once per step, not once per cell. c is the dilatational wave speed
    at rest; mu and lambda bound the stable step, the stress comes from the
    law. */
struct CellConstants
{
  double sound_speed;    // c [m/s]
  double density;        // rho_0 [kg/m^3]
  double mu, lambda;     // Lame's constants [Pa]
  double linear_bulk;    // c1 of the bulk viscosity
  double quadratic_bulk; // c2
};

/**
 * Increment of the displacement gradient in the mid configuration,
 *
 *   l = (F - F_old) F_m^-1,  F_m = (F + F_old)/2
 *
 * (Hughes & Winget 1980): its symmetric part is the strain increment, zero for
 * a rigid rotation, its antisymmetric part the spin increment. Dimensionless.
 * @pre det F_m > 0, which holds where no volume ratio falls by more than a half
 * in the step.
 */
SABOT_IN_LOOP PackMat midpoint_increment(const PackMat &F_old, const PackMat &F)
{
  PackMat change, middle;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      change.m[i][j] = F.m[i][j] - F_old.m[i][j];
      middle.m[i][j] = 0.5 * (F.m[i][j] + F_old.m[i][j]);
    }
  const Pack factor = 1. / determinant(middle);
  PackMat l = multiply(change, adjugate(middle));
  for (auto &row : l.m)
    for (Pack &entry : row)
      entry *= factor;
  return l;
}

/** Shear strains (l_ij + l_ji)/2 and spins (l_ij - l_ji)/2 for ij = xy, yz, xz
    of the increment @p l, into the points @p k to k + 3 of a batch, which has
    the arrays strain[6] and spin[3]. */
template <typename Batch>
SABOT_IN_LOOP void store_shear_and_spin(const PackMat &l, Batch &batch,
                                        const std::size_t k)
{
  store_pack(&batch.strain[3][k], 0.5 * (l.m[0][1] + l.m[1][0]));
  store_pack(&batch.strain[4][k], 0.5 * (l.m[1][2] + l.m[2][1]));
  store_pack(&batch.strain[5][k], 0.5 * (l.m[0][2] + l.m[2][0]));
  store_pack(&batch.spin[0][k], 0.5 * (l.m[0][1] - l.m[1][0]));
  store_pack(&batch.spin[1][k], 0.5 * (l.m[1][2] - l.m[2][1]));
  store_pack(&batch.spin[2][k], 0.5 * (l.m[0][2] - l.m[2][0]));
}

/** An upper bound of the largest eigenvalue of the positive semidefinite
    matrix G (xx, yy, zz, xy, yz, xz): the lesser of trace and Frobenius
    norm, both exact where G has one direction, sqrt(3) too large where it
    has none. In the unit of G, [1/m^2] for squares of gradients. An upper
    bound shortens the step, so it errs on the safe side; an eigenvalue
    solver per cell and step would cost more than it gains. */
SABOT_IN_LOOP Pack largest_eigenvalue_bound(const Pack G[6])
{
  return pack_min(G[0] + G[1] + G[2],
                  pack_sqrt(G[0] * G[0] + G[1] * G[1] + G[2] * G[2] +
                            2. * (G[3] * G[3] + G[4] * G[4] + G[5] * G[5])));
}

/** Step [s] of a cell whose bulk viscosity damps its own compression by the
    fraction xi of critical: central differences with the viscous force of
    half a step before are stable up to 2/omega (sqrt(1 + xi^2) - xi),
    2/omega being the @p undamped step (Belytschko, Liu & Moran 2000, sec.
    6.2). xi = 0 gives the undamped step; it falls like 1/(2 xi) for strong
    damping. For c1 = 0.06 alone it costs six percent. */
SABOT_IN_LOOP Pack damped_step(const Pack undamped, const Pack xi)
{
  return undamped * (pack_sqrt(1. + xi * xi) - xi);
}

/** a . b in each lane. */
inline Pack dot(const Pack a[3], const Pack b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
} // namespace sabot

#endif
