#ifndef sabot_kernels_patch_weights_h
#define sabot_kernels_patch_weights_h

#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
/**
 * Weights that spread a force at @p center over nearby nodes of a surface as a
 * smooth pressure: w_a = phi(|x_a - c|/R) A_a (c_0 + c_1 xi_a + c_2 eta_a),
 * with the cubic spline phi, the nodes' areas A_a and tangential offsets xi,
 * eta from the center, such that sum w = 1 and sum w xi = sum w eta = 0 (no
 * moment about the normal's plane).
 * @param point   x_a [m]
 * @param area    A_a [m^2], parallel to point
 * @param normal  of the surface, unit length
 * @param radius  R [m], beyond which a node takes nothing
 * @param weight  out: w_a, parallel to point, dimensionless
 * @return false when the nodes in reach do not span the surface (the moment
 * matrix of 1, xi, eta is nearly singular), or when a node would be pulled by
 * more than a tenth of the force; the weights are then of no use.
 */
bool patch_weights(const std::vector<Vec> &point,
                   const std::vector<double> &area, const Vec center,
                   const Vec normal, const double radius,
                   std::vector<double> &weight);
} // namespace sabot

#endif
