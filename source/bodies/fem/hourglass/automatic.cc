// Hourglass control by the law: stiffness where nothing ever yields, viscosity
// elsewhere.
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/one_point.h"

namespace sabot
{
namespace
{
const Registry<OnePoint>::Add
    automatic({hourglass_by_law,
               "stiffness for laws that never yield, viscous for all others.",
               {},
               [](const std::string &body_name, const FemOptions &options,
                  std::shared_ptr<const Material> material)
               {
                 return Registry<OnePoint>::get(
                            "Bodies/" + body_name + "/Hourglass control",
                            chosen_hourglass_control(options, *material))
                     .make(body_name, options, std::move(material));
               }});
} // namespace

std::string chosen_hourglass_control(const FemOptions &options,
                                     const Material &material)
{
  if (options.hourglass != hourglass_by_law)
    return options.hourglass;
  return material.initial_yield_stress() ? "viscous" : "stiffness";
}
} // namespace sabot
