#ifndef sabot_loads_time_course_h
#define sabot_loads_time_course_h

#include "sabot/loads/load.h"

#include <memory>

namespace sabot
{
/**
 * By what factor a load's value is multiplied over time. A new course is one
 * file in source/loads/courses with the work, its entries, and its
 * registration.
 */
class TimeCourse
{
public:
  static constexpr const char *kind = "time course";
  /** Reads its entries in the subsection of the load; throws InputError, by the
      entry. */
  using Make = std::unique_ptr<TimeCourse>(const LoadRequest &);
  virtual ~TimeCourse() = default;

  /** The factor at @p time [s]. */
  virtual double value(const double time) const = 0;
  /** Its mean from @p begin to @p end > @p begin [s]: nodes that move with it
      arrive where its integral says. By three Gauss points where a course knows
      nothing better. */
  virtual double mean(const double begin, const double end) const;

  /** The entry "Course", and the entries of all courses. */
  static void declare(Parameters &prm);
  /** What "Course" chooses; InputError where entries of another one are set. */
  static std::unique_ptr<TimeCourse> make(const LoadRequest &request);
};
} // namespace sabot

#endif
