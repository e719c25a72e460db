// Quantity of interest: length of a body.
#include "sabot/simulation/directed_quantity.h"

namespace sabot
{
namespace
{
class Length : public QuantityOfInterest
{
public:
  explicit Length(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, true))
  {
  }
  double value() const override
  {
    return extent(measure_with_particles(along.body), along.axis());
  }
  std::string unit() const override { return "m"; }

private:
  const DirectedQuantity along;
};

const UnitOfQuantity described("length", "m");

const Registry<QuantityOfInterest>::Add
    registered({"length", "extent of the body along the direction.",
                declare_directed_quantity, [](const QuantityRequest &request) {
                  return std::make_unique<Length>(request);
                }});
} // namespace
} // namespace sabot
