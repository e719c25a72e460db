#ifndef sabot_study_analysis_h
#define sabot_study_analysis_h

#include <cstddef>
#include <string>
#include <vector>

namespace sabot
{
/** What a study over spacings says of the limit of spacing 0. */
struct Convergence
{
  bool has_order = false;  // the values fit f0 + a h^p with p in [0.3, 8]
  double order = 0.;       // p
  double limit = 0.;       // f0; the finest value where there is no order
  double uncertainty = 0.; // +-, in the unit of the values
  std::string method;      // how the uncertainty was found, for the report
};

/**
 * Fit f(h) = f0 + a h^p to at least three values by least squares: linear in
 * f0 and a for each p, and the p of the least residual. The uncertainty of the
 * limit follows L. Eca and M. Hoekstra, J. Comput. Phys. 262 (2014) 104,
 * doi 10.1016/j.jcp.2014.01.006, in its outline: with safety factor 1.25
 * where 0.5 <= p <= 2.1 and 3 otherwise times the distance from the finest
 * value to the limit, plus the standard deviation of the fit; where no order
 * is observed, 3 times the range of the values. With three values the fit
 * must meet them all; with more, a deviation of more than half of their range
 * counts as no order: values that go up and down are no power law.
 *
 * @param spacing  [n], > 0, in any order and unit
 * @param value    [n], finite, of the quantity at that spacing
 */
Convergence fit_convergence(const std::vector<double> &spacing,
                            const std::vector<double> &value);

/** Indices of the points that no other point beats in both cost and error,
    by ascending cost: on the way along them each costs more and errs less.
    @p cost and @p error: [n], the less the better; points with values that are
    not finite take no part. */
std::vector<std::size_t> pareto_front(const std::vector<double> &cost,
                                      const std::vector<double> &error);

/** A run as the price list sees it: where it stands among the combinations of
    values, what it took and what it gave. */
struct PricedRun
{
  std::vector<std::size_t> choice; // per parameter, number of its value
  double seconds;                  // CPU time
  double quantity; // NaN: none, and the run has no part in any pair
};

/** What a value of a parameter costs and changes against its first value: the
    mean over the pairs of runs that differ in that alone. In a study that
    varies one parameter at a time that is one pair, in a grid one for each
    combination of the others. */
struct Price
{
  std::size_t parameter, value;
  std::size_t n_pairs;    // of runs that differ in nothing else
  double seconds_saved;   // mean
  double quantity_change; // mean
};

/** Prices of all values for which there are pairs, by parameter and value.
    @p n_values: per parameter. */
std::vector<Price> price_list(const std::vector<PricedRun> &runs,
                              const std::vector<std::size_t> &n_values);
} // namespace sabot

#endif
