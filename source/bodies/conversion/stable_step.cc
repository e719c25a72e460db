// Cells turn into particles before they rule the step.
#include "sabot/base/registry.h"
#include "sabot/bodies/conversion_criterion.h"

#include <cmath>

namespace sabot
{
namespace
{
constexpr const char *entry = "Conversion stable step";

class StableStepShare : public ConversionCriterion
{
public:
  explicit StableStepShare(const double limit) : limit(limit) {}
  bool needs_steps() const override { return true; }
  /** Flattened to that share. */
  Onset onset() const override { return {-std::log(limit), 0.}; }
  void mark(CellConditions &cells, std::vector<char> &unfit) const override
  {
    const std::vector<double> ratio = cells.step_ratio();
    for (std::size_t e = 0; e < ratio.size(); ++e)
      unfit[e] |= ratio[e] < limit;
  }

private:
  const double limit;
};

const Registry<ConversionCriterion>::Add registered(
    {"stable step", "its own stable step has fallen to a share of its start.",
     [](Parameters &prm)
     {
       prm.declare_knob(entry, "0.4", quantity(Dimension::none, 0., 1.),
                        "Stable step of a cell over that of its start below "
                        "which it turns into particles.");
     },
     [](const Parameters &prm, const std::string &) {
       return std::make_shared<const StableStepShare>(get_quantity(prm, entry));
     }});
} // namespace
} // namespace sabot
