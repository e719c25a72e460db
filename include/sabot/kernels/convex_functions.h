#ifndef sabot_kernels_convex_functions_h
#define sabot_kernels_convex_functions_h

#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
/**
 * Generalized meshfree (convex) first-order functions at one point (Wu, Park &
 * Chen 2011, IJNME 85:693):
 *
 *   Psi_J = phi_J G(lambda . D_J) / sum,  D_J = x - x_J,  sum Psi_J D_J = R*,
 *
 * with G(t) = exp t (maximum entropy with the prior phi) or
 * 1 + (2/pi) arctan t; all Psi_J > 0. The gradient is that of the implicit
 * function lambda(x) at constant offset R*: sum grad Psi_J = 0 and
 * sum x_J (x) grad Psi_J = 1 hold to round-off whatever the Newton iteration
 * left. R* = @p inset times the offset of the uncorrected functions moves the
 * point of evaluation from the boundary of the hull, where lambda would be
 * infinite, a little towards the centroid of its neighbors.
 */
class ConvexFunctions
{
public:
  enum class Basis
  {
    exponential,
    arctangent
  };
  explicit ConvexFunctions(const Basis basis, const double inset = 0.3)
      : basis(basis), inset(inset)
  {
  }

  // One entry per neighbor, the point's own node included.
  std::vector<Vec> distance;       // D_J [m]
  std::vector<double> prior;       // phi_J > 0
  std::vector<Vec> prior_gradient; // of phi_J by x [1/m]
  std::vector<double> value;       // out: Psi_J
  std::vector<Vec> gradient;       // out: [1/m]

  /** Forget the neighbors; the arrays keep their room. */
  void clear();
  /** A neighbor: D_J, phi_J, grad phi_J. */
  void add(const Vec d, const double phi, const Vec phi_gradient);

  /**
   * Values and gradients at the point from what add() has collected.
   * @param length  scales the iteration [m], the nodal spacing
   * @return false when the neighbors do not span space (their variance is tiny
   *   along some direction) or Newton's iteration does not converge; values and
   *   gradients are then of no use.
   */
  bool evaluate(const double length);

private:
  /** Psi_J, G and G' at this lambda (in units of 1/length). */
  void weights(const Vec lambda, const double length);
  /** sum Psi_J D_J [m]. */
  Vec offset() const;
  /** Its change with lambda, sum D_J (x) dPsi_J/dlambda. */
  Mat tangent(const double length) const;
  /** Damped Newton iteration for lambda; leaves the weights at it. @return
      whether it converges. */
  bool solve(const double length, Vec &lambda);
  /** By the spread of the functions, not the tangent's: the arctangent's slope
      may be small. */
  bool spans_space(const double length) const;

  const Basis basis;
  const double inset;
  std::vector<double> basis_value, basis_slope; // G, G'
  double sum = 0.;
};
} // namespace sabot

#endif
