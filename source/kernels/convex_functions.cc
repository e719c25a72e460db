// Newton iteration for convex (generalized meshfree) functions at one point.
#include "sabot/kernels/convex_functions.h"

#include <cmath>

namespace sabot
{
namespace
{
constexpr int max_iterations = 50, max_halvings = 20;
constexpr double tolerance = 1e-12; // of the offset, in lengths
/** Below this variance of the neighbors, in lengths squared, they do not span
    space. */
constexpr double least_variance = 1e-4;
} // namespace

void ConvexFunctions::clear()
{
  distance.clear();
  prior.clear();
  prior_gradient.clear();
}

void ConvexFunctions::add(const Vec d, const double phi, const Vec phi_gradient)
{
  distance.push_back(d);
  prior.push_back(phi);
  prior_gradient.push_back(phi_gradient);
}

void ConvexFunctions::weights(const Vec lambda, const double length)
{
  const std::size_t n = prior.size();
  // The exponent's maximum is taken out: only ratios matter.
  double top = 0.;
  if (basis == Basis::exponential)
    for (std::size_t j = 0; j < n; ++j)
      top = std::max(top, dot(lambda, distance[j]) / length);
  sum = 0.;
  for (std::size_t j = 0; j < n; ++j)
  {
    const double t = dot(lambda, distance[j]) / length;
    if (basis == Basis::exponential)
      basis_value[j] = basis_slope[j] = std::exp(t - top);
    else
    {
      basis_value[j] = 1. + M_2_PI * std::atan(t);
      basis_slope[j] = M_2_PI / (1. + t * t);
    }
    sum += prior[j] * basis_value[j];
  }
  for (std::size_t j = 0; j < n; ++j)
    value[j] = prior[j] * basis_value[j] / sum;
}

Vec ConvexFunctions::offset() const
{
  Vec r = {};
  for (std::size_t j = 0; j < prior.size(); ++j)
    r += value[j] * distance[j];
  return r;
}

Mat ConvexFunctions::tangent(const double length) const
{
  const std::size_t n = prior.size();
  Mat A = Mat::zero();
  Vec mean = {};
  for (std::size_t j = 0; j < n; ++j)
    mean += prior[j] * basis_slope[j] / sum / length * distance[j];
  for (std::size_t j = 0; j < n; ++j)
    add_outer(A, distance[j],
              prior[j] * basis_slope[j] / sum / length * distance[j] -
                  value[j] * mean);
  return A;
}

bool ConvexFunctions::solve(const double length, Vec &lambda)
{
  lambda = Vec{};
  weights(lambda, length);
  const Vec target = inset * offset();
  Vec miss = offset() - target;
  for (int i = 0; norm(miss) > tolerance * length; ++i)
  {
    if (i == max_iterations)
      return false;
    const Mat A = tangent(length);
    double det;
    const Mat A_inverse = inverse(A, det);
    if (!(std::abs(det) > 1e-14 * length * length * length))
      return false;
    const Vec step = -(A_inverse * miss);
    double factor = 1.;
    Vec next = {};
    int halving = 0;
    for (; halving < max_halvings; ++halving, factor *= 0.5)
    {
      weights(lambda + factor * step, length);
      next = offset() - target;
      if (norm_square(next) < norm_square(miss))
        break;
    }
    if (halving == max_halvings)
    {
      // Round-off ends the descent: lambda is as good as it gets.
      weights(lambda, length);
      return norm(miss) < 1e-8 * length;
    }
    lambda += factor * step;
    miss = next;
  }
  return true;
}

bool ConvexFunctions::spans_space(const double length) const
{
  const Vec center = offset();
  Mat variance = Mat::zero();
  for (std::size_t j = 0; j < prior.size(); ++j)
    add_outer(variance, value[j] * (distance[j] - center),
              distance[j] - center);
  const double l2 = length * length;
  return determinant(variance) >
         least_variance * least_variance * least_variance * l2 * l2 * l2;
}

bool ConvexFunctions::evaluate(const double length)
{
  const std::size_t n = prior.size();
  value.resize(n);
  gradient.resize(n);
  basis_value.resize(n);
  basis_slope.resize(n);
  Vec lambda;
  if (n < 4 || !solve(length, lambda) || !spans_space(length))
    return false;

  Vec mean_x = {}, mean_lambda = {};
  for (std::size_t j = 0; j < n; ++j)
  {
    const double slope = prior[j] * basis_slope[j] / (sum * length);
    gradient[j] = (basis_value[j] / sum) * prior_gradient[j] + slope * lambda;
    mean_x += gradient[j];
    mean_lambda += slope * distance[j];
  }
  Mat B = Mat::identity();
  for (std::size_t j = 0; j < n; ++j)
  {
    gradient[j] -= value[j] * mean_x;
    add_outer(B, distance[j], gradient[j]);
  }
  const Mat slope_of_lambda = -1. * (inverse(tangent(length)) * B);
  const Mat transposed = transpose(slope_of_lambda);
  for (std::size_t j = 0; j < n; ++j)
    gradient[j] +=
        transposed * (prior[j] * basis_slope[j] / (sum * length) * distance[j] -
                      value[j] * mean_lambda);
  return true;
}
} // namespace sabot
