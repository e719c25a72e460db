// What quantities of a body along a direction share.
#include "sabot/simulation/directed_quantity.h"

#include <cmath>

namespace sabot
{
void declare_body_of_quantity(Parameters &prm)
{
  prm.declare_entry("Body", "", any_text(), "Name of the body.");
}

void declare_directed_quantity(Parameters &prm)
{
  declare_body_of_quantity(prm);
  prm.declare_entry("Direction", "0, 0, 1",
                    quantities(Dimension::none, 3, 3, -1e3, 1e3),
                    "A vector along an axis; its length does not matter.");
}

DirectedQuantity DirectedQuantity::read(const QuantityRequest &request,
                                        const bool is_along_axis)
{
  const std::array<double, 3> d = get_vector(request.prm, "Direction");
  const Vec direction = vec(d[0], d[1], d[2]);
  int n_axes = 0;
  for (const double component : d)
    n_axes += component != 0.;
  if (norm(direction) == 0. || (is_along_axis && n_axes != 1))
    throw InputError(request.path + "/Direction",
                     "give a vector that is not zero and, but for a "
                     "velocity, points along x, y or z");
  return {request.body("Body"), (1. / norm(direction)) * direction};
}

int DirectedQuantity::axis() const
{
  int axis = 0;
  for (int d = 1; d < 3; ++d)
    if (std::abs(direction[d]) > std::abs(direction[axis]))
      axis = d;
  return axis;
}
} // namespace sabot
