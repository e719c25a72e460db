// Bonds fail by the effective plastic strain of their ends.
#include "sabot/base/error.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr const char *entry = "Critical effective plastic strain";

/** Wu & Wu 2018, Eqs. 19-21. */
class EffectivePlasticStrain : public FailureCriterion
{
public:
  using FailureCriterion::FailureCriterion;
  void check(const MaterialPoints &points,
             const std::string &path) const override
  {
    if (can_be_met() && !points.has_state("effective plastic strain"))
      throw InputError(path + "/" + entry,
                       "the body's material has no effective plastic strain; "
                       "use a law with plasticity or remove the entry");
  }
  std::optional<double> critical_plastic_strain(const Material &) const override
  {
    return can_be_met() ? std::optional(critical_value()) : std::nullopt;
  }
  void measure(const MaterialPoints &points, const ParticleFields &,
               double *const value) const override
  {
    std::copy_n(points.state("effective plastic strain"), points.size(), value);
  }
};

const Registry<FailureCriterion>::Add registered(
    {"effective plastic strain", "of the law.",
     [](Parameters &prm)
     {
       declare_critical_strain(prm, entry,
                               "Mean over the ends of a bond above which it "
                               "may fail.");
     },
     [](const Parameters &prm, const std::string &)
     {
       return std::make_unique<const EffectivePlasticStrain>(
           critical_value(prm, entry, 1e10));
     }});
} // namespace
} // namespace sabot
