// Time course: none.
#include "sabot/loads/time_course.h"

namespace sabot
{
namespace
{
class Constant : public TimeCourse
{
public:
  double value(const double) const override { return 1.; }
  double mean(const double, const double) const override { return 1.; }
};

const Registry<TimeCourse>::Add registered(
    {"constant", "1 from time 0 on.", nullptr,
     [](const LoadRequest &) { return std::make_unique<Constant>(); }});
} // namespace
} // namespace sabot
