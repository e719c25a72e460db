// What a rank holds of a mesh.
#include "sabot/geometry/local_part.h"
#include "sabot/geometry/mesh_generator.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

TEST(LocalPart, cells_of_owned_nodes_and_all_their_nodes)
{
  BoxSpecification box;
  box.size = {{3e-3, 1e-3, 1e-3}};
  box.cell_size = 1e-3;
  const HexMesh mesh = make_graded_box(box);
  std::vector<int> owner;
  for (const auto &x : mesh.nodes)
    owner.push_back(x[0] < 0. ? 0 : 1); // planes at -1.5, -0.5, 0.5, 1.5 mm
  std::size_t n_owned = 0, n_owned_cells = 0;
  for (const int rank : {0, 1})
  {
    const LocalPart part = find_local_part(mesh, owner, rank);
    // Its own cell and the one in the middle.
    EXPECT_EQ(part.cells.size(), 2u);
    EXPECT_EQ(part.nodes.size(), 12u);
    EXPECT_EQ(part.n_owned, 8u);
    for (std::size_t i = 0; i < part.nodes.size(); ++i)
    {
      EXPECT_EQ(owner[part.nodes[i]] == rank, i < part.n_owned);
      EXPECT_EQ(part.local.at(part.nodes[i]), i);
    }
    const auto corners = part.connectivity(mesh);
    for (std::size_t e = 0; e < part.cells.size(); ++e)
      for (int a = 0; a < 8; ++a)
        EXPECT_EQ(part.nodes[corners[e][a]], mesh.cells[part.cells[e]][a]);
    n_owned += part.n_owned;
    for (const char is_owned : part.owned_cell)
      n_owned_cells += is_owned;
  }
  EXPECT_EQ(n_owned, mesh.nodes.size());
  EXPECT_EQ(n_owned_cells, mesh.cells.size());
}
} // namespace
