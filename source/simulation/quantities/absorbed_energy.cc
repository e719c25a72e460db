// Quantity of interest: kinetic energy that a body has given away.
#include "sabot/simulation/directed_quantity.h"

namespace sabot
{
namespace
{
/** m_0 v_0^2/2 - m v^2/2 of the centers of mass, of the whole body. Near a
    ballistic limit the residual velocity multiplies errors, this does not. */
class AbsorbedEnergy : public QuantityOfInterest
{
public:
  explicit AbsorbedEnergy(const QuantityRequest &request)
      : body(request.body("Body"))
  {
    const std::array<double, 3> v = body.facts().velocity;
    start = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  }
  double value() const override
  {
    const BodyMeasures m = measure_with_particles(body);
    double square = 0.;
    for (const double v : velocity_of_whole(body))
      square += v * v;
    return 0.5 * copies_by_symmetry(body) *
           ((m.mass + m.eroded_mass) * start - m.mass * square);
  }
  std::string unit() const override { return "J"; }

private:
  const Body &body;
  double start; // square of the velocity at the start
};

const UnitOfQuantity described("absorbed energy", "J");

const Registry<QuantityOfInterest>::Add registered(
    {"absorbed energy",
     "kinetic energy of the body's center of mass that it has lost since the "
     "start, of the whole where planes of symmetry cut it.",
     declare_body_of_quantity, [](const QuantityRequest &request) {
       return std::make_unique<AbsorbedEnergy>(request);
     }});
} // namespace
} // namespace sabot
