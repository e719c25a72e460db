// The curve of residual over impact velocity, and its limit.
#include "sabot/study/ballistic_fit.h"

#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
/** Residual over impact velocity up to which a projectile has been stopped: it
    still swings with the plate. */
constexpr double stopped = 0.02;

double curve(const double a, const double p, const double limit,
             const double impact)
{
  const double x = limit / impact;
  return x < 1. ? a * impact * std::pow(1. - std::pow(x, p), 1. / p) : 0.;
}

/** Residuals of the curve, for Eigen: unknowns a and v_bl over the least impact
    velocity, and with three of them p. */
struct Curve
{
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum
  {
    InputsAtCompileTime = Eigen::Dynamic,
    ValuesAtCompileTime = Eigen::Dynamic
  };

  const std::vector<double> &impact, &residual;
  const double scale;
  const int n_unknowns;

  int inputs() const { return n_unknowns; }
  int values() const { return impact.size(); }
  int operator()(const Eigen::VectorXd &x, Eigen::VectorXd &off) const
  {
    const double p = n_unknowns > 2 ? std::clamp(x[2], 1., 10.) : 2.;
    for (std::size_t i = 0; i < impact.size(); ++i)
    {
      off[i] = curve(x[0], p, scale * x[1], impact[i]) - residual[i];
      // A limit above a shot that perforated: the farther, the worse.
      off[i] -= std::max(0., scale * x[1] - impact[i]);
    }
    return 0;
  }
};
} // namespace

double BallisticFit::residual(const double impact) const
{
  return curve(a, p, limit, impact);
}

BallisticFit fit_ballistic(const std::vector<double> &impact,
                           const std::vector<double> &residual)
{
  std::vector<double> in, out;
  for (std::size_t i = 0; i < impact.size(); ++i)
    if (residual[i] > stopped * impact[i])
    {
      in.push_back(impact[i]);
      out.push_back(residual[i]);
    }
  BallisticFit fit;
  fit.n_perforating = in.size();
  if (in.size() < 2)
    return fit;
  const double least = *std::min_element(in.begin(), in.end());
  fit.deviation = std::numeric_limits<double>::max();
  // From several starts: near the limit the curve is steep.
  for (const double start : {0.5, 0.8, 0.95, 0.999})
  {
    Eigen::NumericalDiff<Curve, Eigen::Central> problem(
        Curve{in, out, least, in.size() >= 4 ? 3 : 2});
    Eigen::LevenbergMarquardt<decltype(problem)> solver(problem);
    solver.parameters.maxfev = 4000;
    Eigen::VectorXd x(problem.inputs());
    x[0] = 0.9;
    x[1] = start;
    if (x.size() > 2)
      x[2] = 2.;
    solver.minimize(x);
    const double deviation = solver.fvec.norm() / std::sqrt(in.size());
    if (!(deviation < fit.deviation))
      continue;
    fit.exists = true;
    fit.deviation = deviation;
    fit.a = x[0];
    fit.limit = least * x[1];
    fit.p = x.size() > 2 ? std::clamp(x[2], 1., 10.) : 2.;
  }
  return fit;
}
} // namespace sabot
