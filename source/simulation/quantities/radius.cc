// Quantity of interest: radius of a body, the mean of both half widths.
#include "sabot/simulation/directed_quantity.h"

namespace sabot
{
namespace
{
class Radius : public QuantityOfInterest
{
public:
  explicit Radius(const QuantityRequest &request)
      : across(DirectedQuantity::read(request, true))
  {
    // What a plane of symmetry cuts is half of the whole.
    for (const SymmetryPlane &plane : across.body.planes_of_symmetry())
      whole[plane.axis] = 2.;
  }
  double value() const override
  {
    const BodyMeasures m = measure_with_particles(across.body);
    const int b = (across.axis() + 1) % 3, c = (across.axis() + 2) % 3;
    return 0.25 * (whole[b] * extent(m, b) + whole[c] * extent(m, c));
  }
  std::string unit() const override { return "m"; }

private:
  const DirectedQuantity across;
  std::array<double, 3> whole{{1., 1., 1.}};
};

const UnitOfQuantity described("radius", "m");

const Registry<QuantityOfInterest>::Add
    registered({"radius",
                "half extent of the body across the direction, of the whole "
                "where planes of symmetry cut it.",
                declare_directed_quantity, [](const QuantityRequest &request) {
                  return std::make_unique<Radius>(request);
                }});
} // namespace
} // namespace sabot
