// Quantity of interest: how far a body has come.
#include "sabot/simulation/directed_quantity.h"

namespace sabot
{
namespace
{
class PenetrationDepth : public QuantityOfInterest
{
public:
  explicit PenetrationDepth(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, true)),
        origin(get_quantity(request.prm, "Origin"))
  {
  }
  double value() const override
  {
    const BodyMeasures m = along.body.measure();
    const int axis = along.axis();
    const double tip = along.direction[axis] > 0. ? m.high[axis] : -m.low[axis];
    return tip - origin;
  }
  std::string unit() const override { return "m"; }

private:
  const DirectedQuantity along;
  const double origin; // [m]
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Origin", "0 m", quantity(Dimension::length, -1e3, 1e3),
                    "Coordinate along the direction from which a penetration "
                    "depth counts.");
}

const UnitOfQuantity described("penetration depth", "m");

const Registry<QuantityOfInterest>::Add
    registered({"penetration depth",
                "how far the body reaches beyond the origin along the "
                "direction.",
                declare, [](const QuantityRequest &request) {
                  return std::make_unique<PenetrationDepth>(request);
                }});
} // namespace
} // namespace sabot
