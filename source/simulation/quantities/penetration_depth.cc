// Quantity of interest: how far a body has come.
#include "sabot/simulation/directed_quantity.h"

#include <limits>

namespace sabot
{
namespace
{
class PenetrationDepth : public QuantityOfInterest
{
public:
  explicit PenetrationDepth(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, true)),
        origin(get_quantity(request.prm, "Origin")),
        keeps_largest(request.prm.get("Value") == "largest")
  {
  }
  void look(const double time) override
  {
    if (keeps_largest && !(now() <= most.depth))
      most = {now(), time};
  }
  double value() const override { return keeps_largest ? most.depth : now(); }
  std::string unit() const override { return "m"; }
  Measures details() const override
  {
    return keeps_largest ? Measures{{"at time", "s", most.time}} : Measures();
  }
  void visit_state(StateVisitor &visitor, const std::string &name) override
  {
    if (!keeps_largest)
      return;
    visitor.visit_value(name + " depth", most.depth);
    visitor.visit_value(name + " time", most.time);
  }

private:
  double now() const
  {
    const BodyMeasures m = measure_with_particles(along.body);
    const int axis = along.axis();
    const double tip = along.direction[axis] > 0. ? m.high[axis] : -m.low[axis];
    return tip - origin;
  }

  struct Reached
  {
    double depth = std::numeric_limits<double>::lowest(), time = 0.; // [m], [s]
  };
  const DirectedQuantity along;
  const double origin; // [m]
  const bool keeps_largest;
  Reached most;
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Origin", "0 m", quantity(Dimension::length, -1e3, 1e3),
                    "Coordinate along the direction from which a penetration "
                    "depth counts.");
  prm.declare_entry("Value", "final", one_of("final|largest"),
                    "Where the body is, or the farthest it has been in the "
                    "rows of the histories so far: what rebounds has been "
                    "deeper.");
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
