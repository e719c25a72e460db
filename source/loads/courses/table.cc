// Time course: straight lines between the points of a table.
#include "sabot/loads/time_course.h"

#include <algorithm>
#include <string>

namespace sabot
{
namespace
{
/** Held at its first and last value outside of the table. */
class Table : public TimeCourse
{
public:
  Table(std::vector<double> times, std::vector<double> factors)
      : times(std::move(times)), factors(std::move(factors))
  {
    integrals.push_back(0.);
    for (std::size_t k = 1; k < this->times.size(); ++k)
      integrals.push_back(integrals.back() +
                          0.5 * (this->factors[k - 1] + this->factors[k]) *
                              (this->times[k] - this->times[k - 1]));
  }
  double value(const double time) const override
  {
    const std::size_t k = next(time);
    if (k == 0 || k == times.size())
      return factors[k == 0 ? 0 : k - 1];
    const double part = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return factors[k - 1] + part * (factors[k] - factors[k - 1]);
  }
  double mean(const double begin, const double end) const override
  {
    return (integral(end) - integral(begin)) / (end - begin);
  }

private:
  /** Number of the first point after @p time, how many there are if none. */
  std::size_t next(const double time) const
  {
    return std::upper_bound(times.begin(), times.end(), time) - times.begin();
  }
  /** Of the factor from the first point on. */
  double integral(const double time) const
  {
    const std::size_t k = next(time);
    if (k == 0)
      return (time - times[0]) * factors[0];
    return integrals[k - 1] +
           0.5 * (factors[k - 1] + value(time)) * (time - times[k - 1]);
  }

  const std::vector<double> times, factors; // [s], 1
  std::vector<double> integrals;            // up to each point [s]
};

void declare(Parameters &prm)
{
  prm.declare_entry("Times", "0 s",
                    quantities(Dimension::time, 1, 10000, -1e6, 1e6),
                    "Times of the table's points, ascending.");
  prm.declare_entry("Factors", "1",
                    quantities(Dimension::none, 1, 10000, -1e12, 1e12),
                    "Factors at these times; before the first and after the "
                    "last time they stay as they are there.");
}

std::unique_ptr<TimeCourse> make(const LoadRequest &request)
{
  const std::vector<double> times = get_quantities(request.prm, "Times"),
                            factors = get_quantities(request.prm, "Factors");
  if (times.size() != factors.size())
    throw InputError(request.path + "/Factors",
                     "has " + std::to_string(factors.size()) +
                         " values for the " + std::to_string(times.size()) +
                         " times of \"Times\"; give one for each");
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1]))
      throw InputError(request.path + "/Times",
                       "value " + std::to_string(k + 1) +
                           " is not later than the one before; times ascend "
                           "(a jump takes a short time, for example 1 ns)");
  return std::make_unique<Table>(times, factors);
}

const Registry<TimeCourse>::Add registered(
    {"table", "straight lines between the points of a table.", declare, make});
} // namespace
} // namespace sabot
