#ifndef sabot_study_ballistic_fit_h
#define sabot_study_ballistic_fit_h

#include <cstddef>
#include <vector>

namespace sabot
{
/**
 * Residual over impact velocity as Recht and Ipson (1963) and Lambert and Jonas
 * (1976) write it,
 *
 *   v_r = a (v_i^p - v_bl^p)^(1/p),  0 up to the limit v_bl.
 */
struct BallisticFit
{
  bool exists = false;
  double a = 1., p = 2., limit = 0.; // limit: v_bl [m/s]
  double deviation = 0.;             // root mean square of the residuals [m/s]
  std::size_t n_perforating = 0;

  /** v_r at @p impact [m/s]. */
  double residual(const double impact) const;
};

/**
 * Least squares over the runs that perforate, by Levenberg and Marquardt. From
 * four of them on a, p and v_bl are free, from two on a and v_bl with p = 2;
 * fewer give no fit.
 *
 * @param impact    [n] impact velocities [m/s], > 0
 * @param residual  [n] residual velocities [m/s]; up to 2 % of the impact
 *                  velocity the projectile has been stopped
 */
BallisticFit fit_ballistic(const std::vector<double> &impact,
                           const std::vector<double> &residual);
} // namespace sabot

#endif
