#ifndef sabot_bodies_fem_corner_fields_h
#define sabot_bodies_fem_corner_fields_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/conversion.h"
#include "sabot/bodies/fem/hexahedra.h"

#include <array>
#include <vector>

namespace sabot
{
/**
 * Volume ratio and stress where the shares of cells lie that go to their
 * corners, or to the sites of their lattices. With the means M_a of cells and
 * particle around each node, trilinear in between, a share of cell e with the
 * middle xi has
 *
 *   s = s_e + M(xi) - M(0),
 *
 * xi = xi_a/2 for the eighth at corner a, so that those of a cell have its mean
 * together. In one dimension a node gets
 * (-1, 9, 9, -1)/16 of the four cells around it, which keeps the amplitude of a
 * wave to the fourth order of its number, where the plain mean loses energy in
 * the second. What a node gets is bounded by what is around it: each value
 * between theirs, and the von Mises stress by their largest.
 */
class CornerFields
{
public:
  /** Of the cells as they are now around the corners of the @p leaving ones,
      and of @p particles that share owned nodes with cells. Collective. */
  CornerFields(const Hexahedra &cells, const NodalState &nodes,
               const GhostExchange &exchange,
               const std::vector<std::size_t> &leaving,
               const std::vector<NodalMatter::Entry> &particles);

  /** Into @p share, a share of cell @p e, volume and stress: those of the cell
      so far. @p middle: of the share, in [-1, 1]^3. */
  void move_to(const std::size_t e, const std::array<double, 3> &middle,
               NodalMatter::Entry &share) const;
  /** Bound the means by what is around these local nodes. */
  void bound(const std::vector<std::size_t> &nodes,
             NodalMatter::Entry &entry) const;

private:
  static constexpr int n = 1 + n_symmetric;
  using Values = std::array<double, n>; // J, stress [Pa]
  struct Around
  {
    Values mean{}, least, largest;
    double volume = 0., mises = 0.;
    void add(const Values &values, const double V_0);
  };
  static Values values_of(const Hexahedra &cells, const std::size_t e);

  const Hexahedra &cells;
  std::vector<Around> around; // [all local nodes], those that are asked for
};
} // namespace sabot

#endif
