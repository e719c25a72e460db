// Heat conduction in hexahedra: assembly, solution, back to the cells.
#include "sabot/bodies/fem/heat_conduction.h"

#include "sabot/bodies/conduction_solver.h"
#include "sabot/kernels/vec.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// Corners in VTK order.
constexpr double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                 {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                 {1, 1, 1},    {-1, 1, 1}};

/** Integral of grad N_a . grad N_b over a hexahedron, 2 x 2 x 2 points. */
void conductance_of_cell(const Vec x[8], double K[8][8])
{
  for (int a = 0; a < 8; ++a)
    std::fill(K[a], K[a] + 8, 0.);
  const double g = 1. / std::sqrt(3.);
  for (int point = 0; point < 8; ++point)
  {
    const double *const s = corner[point];
    Vec derivative[8]; // with the reference coordinates
    Mat jacobian = Mat::zero();
    for (int a = 0; a < 8; ++a)
    {
      const double *const c = corner[a];
      const double f0 = 1. + g * s[0] * c[0], f1 = 1. + g * s[1] * c[1],
                   f2 = 1. + g * s[2] * c[2];
      derivative[a] =
          0.125 * vec(c[0] * f1 * f2, f0 * c[1] * f2, f0 * f1 * c[2]);
      add_outer(jacobian, x[a], derivative[a]);
    }
    double det;
    const Mat pull = transpose(inverse(jacobian, det));
    Vec gradient[8];
    for (int a = 0; a < 8; ++a)
      gradient[a] = pull * derivative[a];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        K[a][b] += det * dot(gradient[a], gradient[b]);
  }
}
} // namespace

HeatConduction::HeatConduction(const double conductivity, const Cells &cells,
                               const std::vector<double> &capacity,
                               const NodalState &nodes,
                               const GhostExchange &exchange,
                               MPI_Comm communicator)
    : conductivity(conductivity), cells(cells), capacity(capacity),
      exchange(exchange), communicator(communicator), n_owned(nodes.n_owned),
      n_nodes(nodes.size()), nodal_capacity(n_nodes, 0.),
      nodal_temperature(n_nodes, 0.), last_temperature(cells.size(), 0.)
{
  std::vector<std::vector<std::uint32_t>> columns(n_owned);
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (const std::uint32_t a : cells[e])
      if (a < n_owned)
      {
        nodal_capacity[a] += 0.125 * capacity[e];
        columns[a].insert(columns[a].end(), cells[e].begin(), cells[e].end());
      }
  for (std::size_t i = 0; i < n_owned; ++i)
    largest_capacity = std::max(largest_capacity, nodal_capacity[i]);
  MPI_Allreduce(MPI_IN_PLACE, &largest_capacity, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
  row_start.push_back(0);
  for (auto &row : columns)
  {
    std::sort(row.begin(), row.end(),
              [&](const std::uint32_t a, const std::uint32_t b)
              { return nodes.global_id[a] < nodes.global_id[b]; });
    row.erase(std::unique(row.begin(), row.end()), row.end());
    column.insert(column.end(), row.begin(), row.end());
    row_start.push_back(column.size());
  }
  conductance.resize(column.size());
}

void HeatConduction::start(const double *const temperature)
{
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    last_temperature[e] = temperature[e];
    for (const std::uint32_t a : cells[e])
      if (a < n_owned)
        nodal_temperature[a] +=
            0.125 * capacity[e] * temperature[e] / nodal_capacity[a];
  }
  is_started = 1.;
}

void HeatConduction::assemble(const NodalState &nodes)
{
  std::fill(conductance.begin(), conductance.end(), 0.);
  for (const auto &cell : cells)
  {
    Vec x[8];
    for (int a = 0; a < 8; ++a)
      x[a] = nodes.position[cell[a]];
    double K[8][8];
    conductance_of_cell(x, K);
    for (int a = 0; a < 8; ++a)
      if (cell[a] < n_owned)
        for (int b = 0; b < 8; ++b)
        {
          std::size_t entry = row_start[cell[a]];
          while (column[entry] != cell[b])
            ++entry;
          conductance[entry] += conductivity * K[a][b];
        }
  }
}

void HeatConduction::multiply(const double dt, std::vector<double> &x,
                              std::vector<double> &product) const
{
  exchange.update(x.data());
  const double scale = dt / largest_capacity;
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    double flux = 0.;
    for (std::size_t k = row_start[i]; k < row_start[i + 1]; ++k)
      flux += conductance[k] * x[column[k]];
    product[i] = nodal_capacity[i] / largest_capacity * x[i] + scale * flux;
  }
}

void HeatConduction::solve(const double dt, const std::vector<double> &right,
                           std::vector<double> &x)
{
  // Everything is scaled by dt over the largest capacity: entries of order 1.
  std::vector<double> diagonal(n_owned);
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    std::size_t k = row_start[i];
    while (column[k] != i)
      ++k;
    diagonal[i] = (nodal_capacity[i] + dt * conductance[k]) / largest_capacity;
  }
  n_iterations = solve_conduction(
      diagonal, right,
      [&](std::vector<double> &p, std::vector<double> &product)
      { multiply(dt, p, product); },
      x, communicator);
}

void HeatConduction::advance(const NodalState &nodes, const double dt,
                             double *const temperature)
{
  if (is_started == 0.)
    start(temperature);
  for (std::size_t e = 0; e < cells.size(); ++e)
    if (temperature[e] != last_temperature[e])
      for (const std::uint32_t a : cells[e])
        if (a < n_owned)
          nodal_temperature[a] += 0.125 * capacity[e] *
                                  (temperature[e] - last_temperature[e]) /
                                  nodal_capacity[a];
  exchange.update(nodal_temperature.data());
  assemble(nodes);
  // (C + dt K) change = -dt K T
  std::vector<double> right(n_owned), change(n_nodes, 0.);
  const double scale = dt / largest_capacity;
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    double flux = 0.;
    for (std::size_t k = row_start[i]; k < row_start[i + 1]; ++k)
      flux += conductance[k] *
              (nodal_temperature[column[k]] - nodal_temperature[i]);
    right[i] = -scale * flux;
  }
  solve(dt, right, change);
  exchange.update(change.data());
  for (std::size_t i = 0; i < n_nodes; ++i)
    nodal_temperature[i] += change[i];
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    double mean = 0.;
    for (const std::uint32_t a : cells[e])
      mean += 0.125 * change[a];
    temperature[e] += mean;
    last_temperature[e] = temperature[e];
  }
}

void HeatConduction::visit_state(StateVisitor &visitor, const StateItems &nodes,
                                 const StateItems &of_cells)
{
  visitor.visit_items("nodal temperature", nodal_temperature, nodes);
  visitor.visit_items("conducted temperature", last_temperature, of_cells);
  visitor.visit_value("conduction started", is_started);
}
} // namespace sabot
