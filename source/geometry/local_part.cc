// Which nodes and cells of a distributed mesh a rank holds.
#include "sabot/geometry/local_part.h"

#include <algorithm>

namespace sabot
{
LocalPart find_local_part(const HexMesh &mesh, const std::vector<int> &owner,
                          const int rank)
{
  LocalPart part;
  part.nodes.reserve(std::count(owner.begin(), owner.end(), rank));
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] == rank)
      part.nodes.push_back(i);
  part.n_owned = part.nodes.size();
  const auto is_here = [&](const std::array<GlobalIndex, 8> &nodes)
  {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const GlobalIndex a) { return owner[a] == rank; });
  };
  const std::size_t n_here =
      std::count_if(mesh.cells.begin(), mesh.cells.end(), is_here);
  part.cells.reserve(n_here);
  part.owned_cell.reserve(n_here);
  std::vector<GlobalIndex> ghosts;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const auto &nodes = mesh.cells[c];
    if (!is_here(nodes))
      continue;
    part.cells.push_back(c);
    part.owned_cell.push_back(
        owner[*std::min_element(nodes.begin(), nodes.end())] == rank);
    for (const GlobalIndex a : nodes)
      if (owner[a] != rank)
        ghosts.push_back(a);
  }
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  part.nodes.insert(part.nodes.end(), ghosts.begin(), ghosts.end());
  for (std::size_t i = 0; i < part.nodes.size(); ++i)
    part.local[part.nodes[i]] = i;
  return part;
}

std::vector<std::array<std::uint32_t, 8>>
LocalPart::connectivity(const HexMesh &mesh) const
{
  std::vector<std::array<std::uint32_t, 8>> corners;
  corners.reserve(cells.size());
  for (const GlobalIndex c : cells)
  {
    std::array<std::uint32_t, 8> nodes;
    for (int a = 0; a < 8; ++a)
      nodes[a] = local.at(mesh.cells[c][a]);
    corners.push_back(nodes);
  }
  return corners;
}
} // namespace sabot
