// Quantity of interest: the outline of a bar, radius at a height.
#include "sabot/simulation/directed_quantity.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
struct Rim
{
  double height = 0., radius = -1.; // [m]
};

/** The outermost node in the slab [low, high] of heights; the lowest of those
    that are equally far out. The same on all ranks. */
Rim outermost(const Body &body, const int axis, const double sign,
              const double low, const double high, MPI_Comm communicator)
{
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  Rim rim;
  for (const Body *part : {&body, body.own_particles})
    for (std::size_t i = 0; part != nullptr && i < part->nodes().n_owned; ++i)
    {
      const Vec x = part->nodes().position[i];
      const double height = sign * x[axis], radius = std::hypot(x[b], x[c]);
      if (height >= low && height <= high &&
          (radius > rim.radius ||
           (radius == rim.radius && height < rim.height)))
        rim = {height, radius};
    }
  double top = rim.radius;
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, communicator);
  double at =
      rim.radius == top ? rim.height : std::numeric_limits<double>::max();
  MPI_Allreduce(MPI_IN_PLACE, &at, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return {at, top};
}

/** Radius about the coordinate axis at a share of the present length above the
    foot, between the outermost nodes of the slabs of one spacing below and
    above. */
class OutlineRadius : public QuantityOfInterest
{
public:
  explicit OutlineRadius(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, true)),
        share(get_quantity(request.prm, "Share of length")),
        communicator(request.communicator)
  {
  }
  double value() const override
  {
    const BodyMeasures m = measure_with_particles(along.body);
    const int axis = along.axis();
    const double sign = along.direction[axis] > 0. ? 1. : -1.,
                 foot = sign > 0. ? m.low[axis] : -m.high[axis],
                 length = extent(m, axis), h = along.body.facts().spacing[axis],
                 height = foot + share * length;
    if (share * length < h)
      return outermost(along.body, axis, sign, foot, foot + h, communicator)
          .radius;
    const Rim below = outermost(along.body, axis, sign, height - h, height,
                                communicator),
              above = outermost(along.body, axis, sign, height, height + h,
                                communicator);
    if (below.radius < 0. || above.radius < 0. || above.height == below.height)
      return std::max(below.radius, above.radius);
    const double part = (height - below.height) / (above.height - below.height);
    return below.radius + part * (above.radius - below.radius);
  }
  std::string unit() const override { return "m"; }

private:
  const DirectedQuantity along;
  const double share;
  MPI_Comm communicator;
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Share of length", "0", quantity(Dimension::none, 0., 1.),
                    "Height above the foot over the present length; 0: the "
                    "foot itself.");
}

const UnitOfQuantity described("outline radius", "m");

const Registry<QuantityOfInterest>::Add
    registered({"outline radius",
                "of the body about the coordinate axis along the direction, at "
                "a height above its foot, the end that the direction points "
                "away from.",
                declare, [](const QuantityRequest &request) {
                  return std::make_unique<OutlineRadius>(request);
                }});
} // namespace
} // namespace sabot
