// Quantities of interest of bodies that come apart: plug, largest piece.
#include "sabot/simulation/directed_quantity.h"

#include <optional>

namespace sabot
{
namespace
{
const FragmentView &pieces_of(const QuantityRequest &request)
{
  const FragmentView *const pieces = request.body("Body").fragments();
  if (pieces == nullptr)
    throw InputError(request.path + "/Body",
                     "\"" + request.prm.get("Body") +
                         "\" cannot come apart; name a body of particles");
  return *pieces;
}

double along(const DirectedQuantity &in, const Fragment &piece)
{
  double v = 0.;
  for (int d = 0; d < 3; ++d)
    v += in.direction[d] * piece.velocity[d];
  return v;
}

/** The heaviest piece but one that moves along the direction: what is punched
    out of a body of which more is left. Single particles are dust. */
class Plug : public QuantityOfInterest
{
public:
  Plug(const QuantityRequest &request, const bool asks_mass)
      : pieces(pieces_of(request)),
        direction(DirectedQuantity::read(request, false)), asks_mass(asks_mass)
  {
  }
  double value() const override
  {
    const std::vector<Fragment> all = pieces.connected_pieces();
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i].n_particles > 1 && along(direction, all[i]) > 0.)
        return asks_mass ? all[i].mass : along(direction, all[i]);
    return 0.;
  }
  std::string unit() const override { return asks_mass ? "kg" : "m/s"; }

private:
  const FragmentView &pieces;
  const DirectedQuantity direction;
  const bool asks_mass;
};

/** Velocity of what is left of a body: of its heaviest piece. */
class LargestPiece : public QuantityOfInterest
{
public:
  explicit LargestPiece(const QuantityRequest &request)
      : direction(DirectedQuantity::read(request, false))
  {
  }
  double value() const override
  {
    Fragment piece;
    if (const FragmentView *const view = direction.body.fragments())
    {
      const std::vector<Fragment> all = view->connected_pieces();
      if (!all.empty()) // a zone may not have found anything yet
        piece = all.front();
    }
    else
      piece.velocity = velocity_of_whole(direction.body);
    return along(direction, piece);
  }
  std::string unit() const override { return "m/s"; }

private:
  const DirectedQuantity direction;
};

const UnitOfQuantity units[] = {
    UnitOfQuantity("plug mass", "kg"), UnitOfQuantity("plug velocity", "m/s"),
    UnitOfQuantity("largest piece velocity", "m/s")};

const Registry<QuantityOfInterest>::Add
    mass({"plug mass",
          "of the heaviest piece of the body, its main piece aside, that has "
          "more than one particle and moves along the direction; of the whole "
          "where planes of symmetry cut it. 0: there is none.",
          declare_directed_quantity,
          [](const QuantityRequest &request)
          { return std::make_unique<Plug>(request, true); }}),
    velocity({"plug velocity",
              "of the same piece along the direction. 0: there is none.",
              declare_directed_quantity,
              [](const QuantityRequest &request)
              { return std::make_unique<Plug>(request, false); }}),
    largest({"largest piece velocity",
             "of the heaviest piece of the body along the direction; of a body "
             "that cannot come apart, its own.",
             declare_directed_quantity, [](const QuantityRequest &request) {
               return std::make_unique<LargestPiece>(request);
             }});
} // namespace
} // namespace sabot
