// Quantity of interest: how wide a hole is.
#include "sabot/simulation/directed_quantity.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** @p least, or the distance of a point from the line through @p center along
    an axis [m] where that is less. */
double nearer_to_line(const double least, const Vec x,
                      const std::array<double, 3> &center, const int axis)
{
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const double to_b = x[b] - center[b], to_c = x[c] - center[c];
  constexpr double round_off = 1e-12;
  if (to_b * to_b + to_c * to_c > (1. + round_off) * least * least)
    return least; // most points: without a root
  return std::min(least, std::hypot(to_b, to_c));
}

/** Twice the least distance of a node of the body's main piece from the line:
    the widest cylinder that passes. */
class HoleDiameter : public QuantityOfInterest
{
public:
  explicit HoleDiameter(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, true)),
        center(get_vector(request.prm, "Center")),
        communicator(request.communicator)
  {
  }
  double value() const override
  {
    const FragmentView *const pieces = along.body.fragments();
    std::vector<GlobalIndex> label;
    GlobalIndex main = -1;
    if (pieces != nullptr)
    {
      const std::vector<Fragment> all = pieces->connected_pieces();
      if (all.empty()) // a zone that has not found anything yet
        return 0.;
      main = all.front().label;
      if (all.size() > 1)
        label = pieces->piece_labels();
    }
    const NodalState &nodes = along.body.nodes();
    constexpr double far = 1e100; // its square is a number
    double least = far;
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      if (label.empty() || label[i] == main)
        least = nearer_to_line(least, nodes.position[i], center, along.axis());
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, communicator);
    return 2. * least;
  }
  std::string unit() const override { return "m"; }

private:
  const DirectedQuantity along;
  const std::array<double, 3> center;
  MPI_Comm communicator;
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Center", "0 m, 0 m, 0 m",
                    quantities(Dimension::length, 3, 3, -1e3, 1e3),
                    "A point of the line about which the hole is measured.");
}

const UnitOfQuantity described("hole diameter", "m");

const Registry<QuantityOfInterest>::Add
    registered({"hole diameter",
                "of the widest cylinder about a line along the direction that "
                "passes the body's main piece without meeting one of its "
                "nodes; next to 0 where there is no hole.",
                declare, [](const QuantityRequest &request) {
                  return std::make_unique<HoleDiameter>(request);
                }});
} // namespace
} // namespace sabot
