// Time course: a formula of the time.
#include "sabot/loads/time_course.h"

#include <deal.II/base/function_parser.h>

#include <cmath>
#include <iostream>

namespace sabot
{
namespace
{
/** By deal.II's function parser. */
class Expression : public TimeCourse
{
public:
  explicit Expression(const std::string &text)
  {
    parser.initialize("t", text, {{"pi", M_PI}}, false);
  }
  double value(const double time) const override
  {
    return parser.value(dealii::Point<1>(time));
  }

private:
  dealii::FunctionParser<1> parser;
};

void declare(Parameters &prm)
{
  prm.declare_entry("Expression", "1", any_text(),
                    "Formula of the time t in seconds, with the functions of "
                    "deal.II's FunctionParser and the constant pi, for example "
                    "\"if(t < 1e-4, sin(pi*t/1e-4), 0)\".");
}

std::unique_ptr<TimeCourse> make(const LoadRequest &request)
{
  const std::string text = request.prm.get("Expression");
  const auto refuse = [&](const std::string &why)
  {
    throw InputError(request.path + "/Expression",
                     "\"" + text + "\" " + why +
                         "; write it with numbers, t and pi, for example "
                         "exp(-t/1e-4)");
  };
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
    auto course = std::make_unique<Expression>(text);
    if (!std::isfinite(course->value(0.)))
      refuse("is no number at t = 0");
    return course;
  }
  catch (const dealii::ExceptionBase &)
  {
    refuse("cannot be read as a formula of t");
  }
  return nullptr;
}

const Registry<TimeCourse>::Add
    registered({"expression", "a formula of the time.", declare, make});
} // namespace
} // namespace sabot
