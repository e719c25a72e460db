// Quantity of interest: velocity of a body, e.g. the residual velocity.
#include "sabot/simulation/directed_quantity.h"

namespace sabot
{
namespace
{
class Velocity : public QuantityOfInterest
{
public:
  explicit Velocity(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, false))
  {
  }
  double value() const override
  {
    const std::array<double, 3> v = velocity_of_whole(along.body);
    return along.direction[0] * v[0] + along.direction[1] * v[1] +
           along.direction[2] * v[2];
  }
  std::string unit() const override { return "m/s"; }

private:
  const DirectedQuantity along;
};

const UnitOfQuantity described("velocity", "m/s");

const Registry<QuantityOfInterest>::Add
    registered({"velocity",
                "of the body's center of mass along the direction; "
                "of the whole where planes of symmetry cut it.",
                declare_directed_quantity, [](const QuantityRequest &request) {
                  return std::make_unique<Velocity>(request);
                }});
} // namespace
} // namespace sabot
