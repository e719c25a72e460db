// What a study concludes from its numbers: order of convergence, Pareto front,
// prices.
#include "sabot/study/analysis.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sabot
{
namespace
{
struct Fit
{
  double limit, slope, residual; // sum of squares
};

Fit fit_for_order(const std::vector<double> &h, const std::vector<double> &f,
                  const double p)
{
  const double n = h.size(), scale = *std::max_element(h.begin(), h.end());
  double mean_x = 0., mean_f = 0.;
  std::vector<double> x;
  for (std::size_t i = 0; i < h.size(); ++i)
  {
    x.push_back(std::pow(h[i] / scale, p));
    mean_x += x[i] / n;
    mean_f += f[i] / n;
  }
  double xx = 0., xf = 0.;
  for (std::size_t i = 0; i < h.size(); ++i)
  {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xf += (x[i] - mean_x) * (f[i] - mean_f);
  }
  Fit fit;
  fit.slope = xf / xx;
  fit.limit = mean_f - fit.slope * mean_x;
  fit.residual = 0.;
  for (std::size_t i = 0; i < h.size(); ++i)
    fit.residual += std::pow(f[i] - fit.limit - fit.slope * x[i], 2);
  return fit;
}

/** The order p of the least residual; nothing where it lies on a bound. */
std::optional<double> best_order(const std::vector<double> &h,
                                 const std::vector<double> &f)
{
  // The residual has one minimum over p for monotone data; a scan keeps the
  // search away from others.
  constexpr double low = 0.3, high = 8.;
  constexpr int n_scan = 200;
  const auto residual = [&](const double p)
  { return fit_for_order(h, f, p).residual; };
  double best = low;
  for (int i = 0; i <= n_scan; ++i)
  {
    const double p = low + (high - low) * i / n_scan;
    if (residual(p) < residual(best))
      best = p;
  }
  double a = std::max(low, best - (high - low) / n_scan),
         b = std::min(high, best + (high - low) / n_scan);
  for (int i = 0; i < 100; ++i)
  {
    const double p = a + 0.382 * (b - a), q = b - 0.382 * (b - a);
    if (residual(p) < residual(q))
      b = q;
    else
      a = p;
  }
  const double p = 0.5 * (a + b);
  if (p < low + 1e-3 || p > high - 1e-3)
    return std::nullopt;
  return p;
}
} // namespace

Convergence fit_convergence(const std::vector<double> &h,
                            const std::vector<double> &f)
{
  Convergence result;
  if (h.empty())
    return result;
  const std::size_t finest = std::min_element(h.begin(), h.end()) - h.begin();
  const auto range = std::minmax_element(f.begin(), f.end());
  result.limit = f[finest];
  result.uncertainty = 3. * (*range.second - *range.first);
  result.method = "3 times the range of the values; no order observed";
  if (h.size() < 3)
  {
    result.method = "3 times the range of the values; an order needs three "
                    "spacings";
    return result;
  }
  if (*range.second == *range.first)
  {
    result.method = "all values are equal";
    return result;
  }
  const std::optional<double> order = best_order(h, f);
  if (!order)
    return result;
  const double p = *order;
  const Fit fit = fit_for_order(h, f, p);
  // Values that go up and down are not a power law, whatever the fit says.
  const double deviation =
      h.size() > 3 ? std::sqrt(fit.residual / (h.size() - 3)) : 0.;
  if (deviation > 0.5 * (*range.second - *range.first) ||
      (h.size() == 3 &&
       fit.residual > 1e-6 * std::pow(*range.second - *range.first, 2)))
    return result;
  result.has_order = true;
  result.order = p;
  result.limit = fit.limit;
  const bool trusted = p >= 0.5 && p <= 2.1;
  result.uncertainty =
      (trusted ? 1.25 : 3.) * std::abs(f[finest] - fit.limit) + deviation;
  result.method = trusted ? "1.25 times the distance from the finest value"
                          : "3 times the distance from the finest value, as "
                            "the order is out of the ordinary";
  return result;
}

std::vector<std::size_t> pareto_front(const std::vector<double> &cost,
                                      const std::vector<double> &error)
{
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < cost.size(); ++i)
    if (std::isfinite(cost[i]) && std::isfinite(error[i]))
      order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](const std::size_t i, const std::size_t j) {
              return cost[i] != cost[j] ? cost[i] < cost[j]
                                        : error[i] < error[j];
            });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || error[i] < error[front.back()])
      front.push_back(i);
  return front;
}

std::vector<Price> price_list(const std::vector<PricedRun> &runs,
                              const std::vector<std::size_t> &n_values)
{
  std::vector<Price> prices;
  for (std::size_t p = 0; p < n_values.size(); ++p)
    for (std::size_t v = 1; v < n_values[p]; ++v)
    {
      Price price{p, v, 0, 0., 0.};
      for (const PricedRun &first : runs)
        for (const PricedRun &other : runs)
        {
          if (first.choice[p] != 0 || other.choice[p] != v)
            continue;
          std::vector<std::size_t> same = other.choice;
          same[p] = 0;
          if (same != first.choice || !std::isfinite(first.quantity) ||
              !std::isfinite(other.quantity))
            continue;
          ++price.n_pairs;
          price.seconds_saved += first.seconds - other.seconds;
          price.quantity_change += other.quantity - first.quantity;
        }
      if (price.n_pairs == 0)
        continue;
      price.seconds_saved /= price.n_pairs;
      price.quantity_change /= price.n_pairs;
      prices.push_back(price);
    }
  return prices;
}
} // namespace sabot
