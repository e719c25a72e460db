// How loads change over time: the choice of a course.
#include "sabot/loads/time_course.h"

#include "sabot/base/choice.h"

#include <cmath>

namespace sabot
{
namespace
{
const char *const standard_course = "constant";
} // namespace

double TimeCourse::mean(const double begin, const double end) const
{
  const double middle = 0.5 * (begin + end),
               arm = 0.5 * std::sqrt(0.6) * (end - begin);
  return (5. * value(middle - arm) + 8. * value(middle) +
          5. * value(middle + arm)) /
         18.;
}

void TimeCourse::declare(Parameters &prm)
{
  Registry<TimeCourse>::declare_choice(
      prm, "Course", standard_course,
      "By what factor the value is multiplied over time.");
  Registry<TimeCourse>::declare_entries(prm, "");
}

std::unique_ptr<TimeCourse> TimeCourse::make(const LoadRequest &request)
{
  const Parameters &prm = request.prm;
  refuse_unused<TimeCourse>(prm, request.path, "Course");
  return Registry<TimeCourse>::get(request.path + "/Course", prm.get("Course"))
      .make(request);
}
} // namespace sabot
