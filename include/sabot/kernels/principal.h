#ifndef sabot_kernels_principal_h
#define sabot_kernels_principal_h

#include "sabot/kernels/vec.h"

namespace sabot
{
/**
 * Inverse of a symmetric positive semidefinite moment matrix whose small
 * eigenvalues are damped: with the spectrum M = sum e_i n_i (x) n_i,
 *
 *   M^-1 ~ sum g(e_i) n_i (x) n_i,  g(e) = 1/e           for e >= threshold,
 *                                   g(e) = e/threshold^2 below,
 *
 * continuous at the threshold and zero where a direction is lost, so that
 * gradients fade there instead of growing without bound.
 * @param threshold  of the eigenvalues, in their unit, > 0
 * @param n_damped   out: number of directions below the threshold
 */
Mat damped_inverse(const Mat &moment, const double threshold, int &n_damped);

/** Remove the tensile principal values of the symmetric tensor s (components
    xx, yy, zz, xy, yz, xz; positive in tension): what a crack still
    carries. */
void cut_tension(double s[6]);

/** Largest principal value of the symmetric tensor s (xx, yy, zz, xy, yz,
    xz), in its unit; of a stress positive in tension. */
double largest_principal(const double s[6]);

/** Middle eigenvalue of a symmetric matrix, in its unit. */
double middle_eigenvalue(const Mat &moment);

/**
 * Keep a support from growing or shrinking without bound: with the kernel
 * matrix @p h [m], that maps the unit ball to the present support, and the
 * initial semi-axes @p axes [m], h = h' diag(axes) and h' = U S V^T, limit the
 * singular values to S in [low, high]; rotation and axes of stretch stay.
 * @pre 0 < low < 1 < high. Kernels far from the limits return as they were.
 */
Mat clamp_kernel(const Mat &h, const Vec axes, const double low,
                 const double high);

/** The same for kernels that start as any regular matrix: h = h' @p initial. */
Mat clamp_kernel(const Mat &h, const Mat &initial, const double low,
                 const double high);
} // namespace sabot

#endif
