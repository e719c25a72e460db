// Cells turn into particles before they have flowed so far as to fail.
#include "sabot/base/error.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/conversion_criterion.h"
#include "sabot/materials/material.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr const char *entry = "Conversion plastic strain",
                     *variable = "effective plastic strain";

class PlasticStrain : public ConversionCriterion
{
public:
  explicit PlasticStrain(const double limit) : limit(limit) {}
  void check(const Material &law, const std::string &path) const override
  {
    const auto states = law.state_variables();
    if (std::none_of(states.begin(), states.end(),
                     [](const StateVariable &v) { return v.name == variable; }))
      throw InputError(path + "/Converts by",
                       "names plastic strain, but the body's material never "
                       "flows; use a law that does, or another criterion");
  }
  Onset onset() const override { return {limit, 0.}; }
  void mark(CellConditions &cells, std::vector<char> &unfit) const override
  {
    const std::vector<double> strain = cells.state(variable);
    for (std::size_t e = 0; e < strain.size(); ++e)
      unfit[e] |= strain[e] >= limit;
  }

private:
  const double limit;
};

const Registry<ConversionCriterion>::Add registered(
    {"plastic strain",
     "the cell's effective plastic strain reaches a limit, to be well below "
     "that "
     "of failure.",
     [](Parameters &prm)
     {
       prm.declare_knob(entry, "0.02", quantity(Dimension::none, 0., 1e3),
                        "Effective plastic strain at which a cell turns into "
                        "particles; well before flow localizes.");
     },
     [](const Parameters &prm, const std::string &) {
       return std::make_shared<const PlasticStrain>(get_quantity(prm, entry));
     }});
} // namespace
} // namespace sabot
