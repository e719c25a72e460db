// Cells turn into particles before they are too distorted to be trusted.
#include "sabot/base/registry.h"
#include "sabot/bodies/conversion_criterion.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr const char *jacobian_entry = "Conversion scaled Jacobian",
                     *aspect_entry = "Conversion aspect ratio";

class Shape : public ConversionCriterion
{
public:
  Shape(const double least_jacobian, const double largest_aspect)
      : least_jacobian(least_jacobian), largest_aspect(largest_aspect)
  {
  }
  /** Flattened at constant volume, edges over thickness exp(3/2 strain), or
      sheared by a strain of tan(angle)/sqrt(3); whichever comes first. */
  Onset onset() const override
  {
    const double cosine = std::max(least_jacobian, 1e-3);
    return {std::min(2. / 3. * std::log(largest_aspect),
                     std::sqrt((1. / (cosine * cosine) - 1.) / 3.)),
            0.};
  }
  void mark(CellConditions &cells, std::vector<char> &unfit) const override
  {
    const std::vector<double> jacobian = cells.scaled_jacobian(),
                              aspect = cells.stretch_of_aspect();
    for (std::size_t e = 0; e < jacobian.size(); ++e)
      unfit[e] |= jacobian[e] < least_jacobian || aspect[e] > largest_aspect;
  }

private:
  const double least_jacobian, largest_aspect;
};

const Registry<ConversionCriterion>::Add registered(
    {"shape", "it is skewed or flattened.",
     [](Parameters &prm)
     {
       prm.declare_knob(jacobian_entry, "0.4",
                        quantity(Dimension::none, 0., 1.),
                        "Least scaled Jacobian of a cell's corners below which "
                        "it turns into particles; 1: a brick, 0: flat.");
       prm.declare_knob(aspect_entry, "3", quantity(Dimension::none, 1., 1e6),
                        "Longest over shortest edge, over the same of the "
                        "undeformed cell, above which it turns into "
                        "particles.");
     },
     [](const Parameters &prm, const std::string &)
     {
       return std::make_shared<const Shape>(get_quantity(prm, jacobian_entry),
                                            get_quantity(prm, aspect_entry));
     }});
} // namespace
} // namespace sabot
