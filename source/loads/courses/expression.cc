// Time course: a formula of the time.
#include "sabot/base/text.h"
#include "sabot/loads/time_course.h"

#include <deal.II/base/function_parser.h>

#include <cmath>
#include <iostream>

namespace sabot
{
namespace
{
/** By deal.II's function parser. What is no number ends the run: it would be
    found as not-a-number somewhere else. All ranks ask for the same times. */
class Expression : public TimeCourse
{
public:
  Expression(const std::string &entry, const std::string &text)
      : entry(entry), text(text)
  {
    parser.initialize("t", text, {{"pi", M_PI}}, false);
  }
  /** What may be no number. */
  double unchecked_value(const double time) const
  {
    return parser.value(dealii::Point<1>(time));
  }
  double value(const double time) const override
  {
    const double factor = unchecked_value(time);
    if (!std::isfinite(factor))
      throw PhysicsError(entry + ": \"" + text +
                         "\" is no number at t = " + formatted("%.6g s", time));
    return factor;
  }

private:
  const std::string entry, text;
  dealii::FunctionParser<1> parser;
};

void declare(Parameters &prm)
{
  prm.declare_entry("Expression", "1", any_text(),
                    "Formula of the time t in seconds, with the functions of "
                    "deal.II's FunctionParser and the constant pi, for example "
                    "\"if(t < 1e-4, sin(pi*t/1e-4), 0)\"; a number at "
                    "all times of the run.");
}

std::unique_ptr<TimeCourse> make(const LoadRequest &request)
{
  const std::string entry = request.path + "/Expression",
                    text = request.prm.get("Expression");
  const auto refuse = [&](const std::string &why, const std::string &instead)
  { throw InputError(entry, "\"" + text + "\" " + why + "; " + instead); };
  const std::string example =
      "write it with numbers, t and pi, for example exp(-t/1e-4)";
  // deal.II also prints what its parser says, over several lines.
  struct Quiet
  {
    std::streambuf *const before = std::cerr.rdbuf(nullptr);
    ~Quiet()
    {
      std::cerr.rdbuf(before);
      std::cerr.clear();
    }
  };
  try
  {
    const Quiet quiet;
    auto course = std::make_unique<Expression>(entry, text);
    constexpr int n_samples = 1000; // the run looks at each of its steps
    for (int k = 0; k <= n_samples; ++k)
    {
      const double time = request.end_time * k / n_samples;
      if (!std::isfinite(course->unchecked_value(time)))
        refuse(
            formatted("is no number at t = %.6g s", time),
            k == 0
                ? example
                : "write one that is a number up to the end time, for example "
                  "if(t < 1e-4, sqrt(1e-4 - t), 0)");
    }
    return course;
  }
  catch (const dealii::ExceptionBase &)
  {
    refuse("cannot be read as a formula of t", example);
  }
  return nullptr;
}

const Registry<TimeCourse>::Add
    registered({"expression", "a formula of the time.", declare, make});
} // namespace
} // namespace sabot
