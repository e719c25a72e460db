// Adds the quantity of interest "velocity of a piece": of the n-th heaviest
// piece of a body that may come apart,
//
//   v = e . p/m,
//
// m and p mass and momentum of the particles that unbroken bonds connect, e the
// direction: the residual velocity of a plug, say, which no average over the
// body shows. To keep it, copy this file into source/simulation/quantities.
// Scene: quantity.prm.
#include "sabot/simulation/directed_quantity.h"

#include <algorithm>

namespace sabot
{
namespace
{
class VelocityOfPiece : public QuantityOfInterest
{
public:
  explicit VelocityOfPiece(const QuantityRequest &request)
      : along(DirectedQuantity::read(request, false)),
        number(request.prm.get_integer("Piece"))
  {
    if (along.body.fragments() == nullptr)
      throw InputError(request.path + "/Body",
                       "the body \"" + along.body.name +
                           "\" cannot come apart; name one of particles");
  }
  double value() const override
  {
    // The same on all ranks. A velocity is that of the whole, also where planes
    // of symmetry cut the body.
    const std::vector<Fragment> pieces =
        along.body.fragments()->connected_pieces();
    if (pieces.empty())
      return 0.;
    const auto &v = pieces[std::min(number, pieces.size()) - 1].velocity;
    return along.direction[0] * v[0] + along.direction[1] * v[1] +
           along.direction[2] * v[2];
  }
  std::string unit() const override { return "m/s"; }

private:
  const DirectedQuantity along;
  const std::size_t number; // from 1 on
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Piece", "1", integer(1, 1000000),
                    "Which piece, 1 the heaviest; the lightest while there are "
                    "fewer.");
}

const Registry<QuantityOfInterest>::Add registered(
    {"velocity of a piece",
     "along the direction, of a piece into which the body has come apart.",
     declare, [](const QuantityRequest &request) {
       return std::make_unique<VelocityOfPiece>(request);
     }});
} // namespace
} // namespace sabot
