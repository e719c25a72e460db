// Split hexahedra: lattices that meet, shares of cells, places of sites.
#include "sabot/geometry/split_mesh.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/round_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace
{
using namespace sabot;

HexMesh block(const double cell_size)
{
  BoxSpecification box;
  box.size = {{6e-3, 4e-3, 2e-3}};
  box.center = {{1e-3, 0., 0.}};
  box.cell_size = cell_size;
  return make_graded_box(box);
}

std::vector<GlobalIndex> all_of(const SplitMesh &split)
{
  std::vector<GlobalIndex> all(split.n_sites());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

double distance(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  return std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) +
                   std::pow(a[2] - b[2], 2));
}

TEST(SplitMesh, cells_that_are_not_split_have_their_corners)
{
  const HexMesh mesh = block(1e-3);
  const SplitMesh split(mesh, 1.2e-3);
  EXPECT_EQ(split.parts(), std::make_pair(1u, 1u));
  EXPECT_EQ(split.n_sites(), GlobalIndex(mesh.nodes.size()));
  for (const SplitMesh::Member &member : split.members(7))
  {
    EXPECT_EQ(member.share, 0.125);
    EXPECT_EQ(std::abs(member.middle[1]), 0.5);
  }
}

TEST(SplitMesh, a_split_block_is_the_fine_one)
{
  const SplitMesh split(block(2e-3), 1e-3);
  const ParticleCloud fine = make_mesh_cloud(block(1e-3));
  const AlignedVector<Vec> normals = outward_normals(fine, 2);
  const std::vector<double> spacings = surface_spacings(fine, 2);
  ASSERT_EQ(split.n_sites(), GlobalIndex(fine.position.size()));
  AlignedVector<Vec> outward;
  std::vector<double> along;
  const ParticleCloud cloud = split.cloud_of(all_of(split), 2, outward, along);
  for (std::size_t k = 0; k < cloud.position.size(); ++k)
  {
    std::size_t other = 0;
    while (distance(fine.position[other], cloud.position[k]) > 1e-9)
      ASSERT_LT(++other, fine.position.size());
    EXPECT_NEAR(cloud.volume[k], fine.volume[other], 1e-24);
    EXPECT_EQ(cloud.on_face[k], fine.on_face[other]);
    EXPECT_LT(norm(outward[k] - normals[other]), 1e-12);
    EXPECT_NEAR(along[k], spacings[other], 1e-15);
    for (int d = 0; d < 3; ++d)
      EXPECT_LT(norm(cloud.shape[k].row[d] - fine.shape[other].row[d]), 1e-15);
  }
}

/** Lattices of a cylinder, and of a block that grows coarse: they meet, their
    shares are those of the nodes, and few sites are as all of them. */
TEST(SplitMesh, lattices_meet_and_share_the_mass)
{
  BoxSpecification graded;
  graded.size = {{9e-3, 9e-3, 3e-3}};
  graded.cell_size = 1e-3;
  graded.has_zone = true;
  graded.zone_is_cut = false;
  graded.zone_size = {{3e-3, 3e-3, 3e-3}};
  graded.coarsest_cell_size = 3e-3;
  graded.growth_ratio = 1.5;
  for (const auto &[mesh, spacing] :
       {std::make_pair(make_cylinder(4e-3, 5e-3, 2, {{0., 0., 0.}}, 2e-3, 2),
                       0.7e-3),
        std::make_pair(make_graded_box(graded), 1e-3)})
  {
    const SplitMesh split(mesh, spacing);
    EXPECT_GT(split.parts().second, split.parts().first);
    AlignedVector<Vec> outward;
    std::vector<double> along;
    const ParticleCloud cloud =
        split.cloud_of(all_of(split), 0, outward, along);
    double whole = 0., parts = 0.;
    std::vector<int> seen(split.n_sites(), 0);
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      whole += mesh.volume[c];
      std::array<double, 8> at_node{};
      for (const SplitMesh::Member &member : split.members(c))
      {
        ++seen[member.site];
        const SplitMesh::Carrier on = split.carrier(member.site);
        EXPECT_EQ(on.node[0],
                  *std::min_element(on.node.begin(), on.node.begin() + on.n));
        const auto around = split.cells_around(on);
        EXPECT_TRUE(
            std::binary_search(around.begin(), around.end(), GlobalIndex(c)));
        for (int a = 0; a < on.n; ++a)
          for (int corner = 0; corner < 8; ++corner)
            if (mesh.cells[c][corner] == on.node[a])
              at_node[corner] += on.weight[a] * member.share;
      }
      for (const double share : at_node)
        EXPECT_NEAR(share, 0.125, 1e-14);
    }
    for (GlobalIndex site = 0; site < split.n_sites(); ++site)
    {
      parts += cloud.volume[site];
      EXPECT_EQ(seen[site],
                int(split.cells_around(split.carrier(site)).size()));
    }
    EXPECT_NEAR(parts, whole, 1e-12 * whole);
    const std::vector<GlobalIndex> some{split.n_sites() - 1,
                                        split.n_sites() / 2, 3};
    AlignedVector<Vec> normal;
    std::vector<double> spacings;
    const ParticleCloud few = split.cloud_of(some, 0, normal, spacings);
    for (std::size_t k = 0; k < some.size(); ++k)
    {
      EXPECT_EQ(few.position[k], cloud.position[some[k]]);
      EXPECT_EQ(few.volume[k], cloud.volume[some[k]]);
      EXPECT_EQ(spacings[k], along[some[k]]);
      EXPECT_EQ(norm(normal[k] - outward[some[k]]), 0.);
      for (int d = 0; d < 3; ++d)
        EXPECT_EQ(norm(few.shape[k].row[d] - cloud.shape[some[k]].row[d]), 0.);
    }
  }
}
} // namespace
