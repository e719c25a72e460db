// Bonds fail by the damage that the law of their ends has gathered.
#include "sabot/base/error.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr const char *entry = "Critical damage";

/** Any law's state "damage", 1 at fracture: plastic strain over the fracture
    strain at its triaxiality, rate and temperature for Johnson-Cook. */
class Damage : public FailureCriterion
{
public:
  using FailureCriterion::FailureCriterion;
  void check(const MaterialPoints &points,
             const std::string &path) const override
  {
    if (can_be_met() && !points.has_state("damage"))
      throw InputError(path + "/Failure criterion",
                       "is damage, but the body's material gathers none; use a "
                       "law with damage, as Johnson-Cook with \"Damage = "
                       "true\" and D1 to D5, or another criterion");
  }
  std::optional<double>
  critical_plastic_strain(const Material &law) const override
  {
    const std::optional<double> strain = law.slow_fracture_strain(0.);
    if (!can_be_met() || !strain)
      return std::nullopt;
    return critical_value() * *strain;
  }
  void measure(const MaterialPoints &points, const ParticleFields &,
               double *const value) const override
  {
    std::copy_n(points.state("damage"), points.size(), value);
  }
};

const Registry<FailureCriterion>::Add registered(
    {"damage",
     "that the law gathers, 1 at fracture: Johnson-Cook with damage, by "
     "triaxiality, rate and temperature.",
     [](Parameters &prm)
     {
       prm.declare_entry(entry, "1",
                         word_or("never", quantity(Dimension::none, 0.)),
                         "Mean over the ends of a bond above which it may "
                         "fail.");
     },
     [](const Parameters &prm, const std::string &) {
       return std::make_unique<const Damage>(critical_value(prm, entry, 1e10));
     }});
} // namespace
} // namespace sabot
