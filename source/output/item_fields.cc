// Fields of a body as values of its cells or particles.
#include "sabot/output/item_fields.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Mean over the nodes of each item of @p n values a node. */
std::vector<double> means(const OutputMesh &mesh,
                          const std::vector<double> &values,
                          const unsigned int n)
{
  const unsigned int per_item = mesh.nodes_per_cell;
  const std::size_t n_items = mesh.connectivity.size() / per_item;
  std::vector<double> mean(n_items * n, 0.);
  for (std::size_t i = 0; i < n_items; ++i)
    for (unsigned int a = 0; a < per_item; ++a)
      for (unsigned int c = 0; c < n; ++c)
        mean[n * i + c] +=
            values[n * mesh.connectivity[per_item * i + a] + c] / per_item;
  return mean;
}
} // namespace

std::vector<std::array<double, 3>> item_positions(const OutputMesh &mesh)
{
  const std::vector<double> mean = means(mesh, mesh.points, 3);
  std::vector<std::array<double, 3>> positions;
  for (std::size_t i = 0; i < mean.size(); i += 3)
    positions.push_back({{mean[i], mean[i + 1], mean[i + 2]}});
  return positions;
}

std::optional<OutputField> item_field(const OutputMesh &mesh,
                                      const std::string &name)
{
  for (const OutputField &field : mesh.cell_fields)
    if (field.name == name)
      return field;
  for (const OutputField &field : mesh.point_fields)
    if (field.name == name)
      return OutputField{field.name, field.unit, field.n_components,
                         means(mesh, field.values, field.n_components)};
  return std::nullopt;
}

std::string component_name(const unsigned int n, const unsigned int c)
{
  const char *const of_tensor[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  return n == 1   ? std::string()
         : n == 3 ? std::string(1, "xyz"[c])
                  : std::string(of_tensor[c]);
}

int least_row(std::vector<double> &row, const std::size_t length,
              MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<double> mine = {row.empty() ? 0. : 1.};
  mine.insert(mine.end(), row.begin(), row.end());
  mine.resize(length + 1);
  std::vector<double> all(mine.size() * n_ranks);
  MPI_Allgather(mine.data(), mine.size(), MPI_DOUBLE, all.data(), mine.size(),
                MPI_DOUBLE, communicator);
  int winner = -1;
  row.clear();
  for (int r = 0; r < n_ranks; ++r)
  {
    const auto begin = all.begin() + r * mine.size();
    const std::vector<double> its(begin + 1, begin + mine.size());
    if (*begin > 0. && (winner < 0 || its < row))
    {
      winner = r;
      row = its;
    }
  }
  return winner;
}
} // namespace sabot
