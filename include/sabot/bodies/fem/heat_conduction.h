#ifndef sabot_bodies_fem_heat_conduction_h
#define sabot_bodies_fem_heat_conduction_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"

#include <array>
#include <vector>

namespace sabot
{
/**
 * Heat conduction in hexahedra, rho_0 c dT/dt = div(k grad T) in the present
 * configuration with insulated faces, by backward Euler on trilinear nodal
 * temperatures with lumped capacity; conducts between steps of the motion.
 *
 * Cells keep their temperatures: what they gained since the last call (plastic
 * heating) goes to their nodes, heat is conducted there, and the change alone
 * comes back as the mean over a cell's nodes. No heat is gained or lost, and
 * without conduction nothing is smoothed.
 *
 * Solved by conjugate gradients (conduction_solver.h). Rows are summed in
 * global order, so that the result does not depend on the number of ranks.
 */
class HeatConduction
{
public:
  using Cells = std::vector<std::array<std::uint32_t, 8>>;
  /** @p cells ascending in global order, all of the owned nodes' cells.
      @param capacity  rho_0 c V_0 of each cell [J/K] */
  HeatConduction(const double conductivity, const Cells &cells,
                 const std::vector<double> &capacity, const NodalState &nodes,
                 const GhostExchange &exchange, MPI_Comm communicator);

  /** Conduct for @p dt [s]; @p temperature of the cells [K] is updated.
      Collective. (C + dt K) dT = -dt K T for the change alone, C lumped; T
      of the nodes is kept between calls. Ghosts' positions must be up to
      date. Throws PhysicsError where the iteration does not converge. */
  void advance(const NodalState &nodes, const double dt, double *temperature);

  /** Nodal temperatures and those that the cells had after the last call. */
  void visit_state(StateVisitor &visitor, const StateItems &nodes,
                   const StateItems &of_cells);
  /** Of the conjugate gradients, for tests. */
  unsigned int last_iterations() const { return n_iterations; }

private:
  /** Nodal temperatures with the heat of the cells around; once. Means of
      the cells around a node, weighted by their capacities, so that the heat
      is that of the cells. */
  void start(const double *temperature);
  /** K_ab = k integral(grad N_a . grad N_b) at the present positions, 2x2x2
      Gauss points [W/K]. Every call anew, as cells deform; rows of owned
      nodes are complete, since all cells around them are here. */
  void assemble(const NodalState &nodes);
  /** product = (C + dt K) x / C_max, C_max the largest nodal capacity of all
      ranks, for owned nodes; ghosts of x are set first. */
  void multiply(const double dt, std::vector<double> &x,
                std::vector<double> &product) const;
  /** (C + dt K) x = right, scaled by the largest capacity. */
  void solve(const double dt, const std::vector<double> &right,
             std::vector<double> &x);

  const double conductivity;
  const Cells &cells;
  const std::vector<double> capacity;
  const GhostExchange &exchange;
  MPI_Comm communicator;
  std::size_t n_owned, n_nodes;
  double largest_capacity = 0.; // over nodes and ranks, scales dot products
  std::vector<double> nodal_capacity, nodal_temperature, last_temperature;
  double is_started = 0.;
  unsigned int n_iterations = 0;
  // Rows of owned nodes, columns in ascending global order
  std::vector<std::size_t> row_start;
  std::vector<std::uint32_t> column;
  std::vector<double> conductance; // [W/K]
};
} // namespace sabot

#endif
