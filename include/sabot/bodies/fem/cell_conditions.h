#ifndef sabot_bodies_fem_cell_conditions_h
#define sabot_bodies_fem_cell_conditions_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/conversion_criterion.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/fem/living_cells.h"

#include <vector>

namespace sabot
{
/** Hexahedra as the criteria of conversion see them; lives during one look. */
class FemCellConditions : public CellConditions
{
public:
  /** @param start_steps  stable steps by initial cell [s], or empty
      @param is_failed    [all local nodes] beside broken bonds */
  FemCellConditions(const NodalState &nodes, const GhostExchange &exchange,
                    const Hexahedra &cells, const LivingCells &living,
                    const std::vector<double> &start_steps,
                    const std::vector<char> &is_failed)
      : nodes(nodes), exchange(exchange), cells(cells), living(living),
        start_steps(start_steps), is_failed(is_failed)
  {
  }

  std::size_t size() const override { return cells.size(); }
  std::vector<std::array<double, 3>> centers() const override;
  std::vector<double> state(const std::string &name) const override
  {
    return cells.cell_state(name);
  }
  std::vector<double> step_ratio() override;
  std::vector<double> scaled_jacobian() const override;
  std::vector<double> stretch_of_aspect() const override;
  std::vector<char> near_failure(const unsigned int layers) const override;

private:
  const NodalState &nodes;
  const GhostExchange &exchange;
  const Hexahedra &cells;
  const LivingCells &living;
  const std::vector<double> &start_steps;
  const std::vector<char> &is_failed;
};
} // namespace sabot

#endif
