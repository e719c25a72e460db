// What is said of meshes after reading: pieces, coincident nodes, equal and
// inverted cells, planes of faces.
#include "mesh_files.h"

namespace
{
using namespace sabot;

TEST(MeshChecks, doubled_nodes_are_told_and_joined)
{
  // The upper half has nodes of its own, half a nanometer off.
  Block block;
  const Block whole;
  for (int i = 9; i < 18; ++i)
  {
    block.nodes.push_back(whole.nodes[i]);
    block.nodes.back()[0] += 0.5e-6;
  }
  for (int c = 4; c < 8; ++c)
    for (int &node : block.cells[c])
      node += node <= 18 ? 18 : 0;
  const std::string text = block.abaqus();
  MeshWish wish;
  wish.unit = 1e-3;
  const NamedMesh loose = read_text("halves.inp", text, wish);
  ASSERT_EQ(loose.warnings.size(), 1u);
  EXPECT_TRUE(has(loose.warnings[0],
                  "2 pieces that share no node, 9 coincident nodes, the first "
                  "at (5e-07, 0, 1) mm"))
      << loose.warnings[0];
  EXPECT_TRUE(has(loose.warnings[0], "joined it would be 1 piece"));
  EXPECT_EQ(loose.mesh.nodes.size(), 36u);
  wish.joining = 1e-6;
  const NamedMesh joined = read_text("halves.inp", text, wish);
  EXPECT_TRUE(joined.warnings.empty());
  EXPECT_EQ(joined.mesh.nodes.size(), 27u);
  EXPECT_EQ(joined.mesh.boundary_faces.size(), 24u);
}

TEST(MeshChecks, hinges_are_told)
{
  Block block;
  block.cells = {block.cells[0], block.cells[3]};
  const NamedMesh made = read_text("hinge.inp", block.abaqus());
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_TRUE(has(made.warnings[0], "2 pieces of cells that share faces"));
}

TEST(MeshChecks, pieces_that_lie_in_each_other_are_refused)
{
  // A second block beside the first, shifted along x.
  const auto two = [](const double shift, const double size = 1.)
  {
    Block block;
    const Block other(size);
    for (const auto &x : other.nodes)
      block.nodes.push_back({{x[0] + shift, x[1], x[2]}});
    for (auto cell : other.cells)
    {
      for (int &node : cell)
        node += 27;
      block.cells.push_back(cell);
    }
    return block.abaqus();
  };
  for (const double shift : {0.5, 0.3, -0.7, 1.4, 1.7, -1.5})
    EXPECT_TRUE(has(refusal("overlap.inp", two(shift)), "of another piece"))
        << shift;
  for (const double size : {0.1, 0.3, 5.})
    EXPECT_TRUE(has(refusal("overlap.inp", two(0.1, size)), "of another piece"))
        << size;
  // Beside each other, and as little into each other as faceted rounds do.
  for (const double shift : {2., 2.1, -2., 1.999, 1.95})
    EXPECT_EQ(read_text("beside.inp", two(shift)).mesh.cells.size(), 16u)
        << shift;
}

TEST(MeshChecks, cells_that_stand_twice_or_overlap_are_refused)
{
  Block block;
  block.cells.push_back(block.cells[2]);
  EXPECT_TRUE(has(refusal("twice.inp", block.abaqus(11)),
                  "19 has the corners of cell 13 at (500, 1500, 500) mm"));
  // The same by other nodes at the same places.
  for (int &node : block.cells.back())
  {
    block.nodes.push_back(block.nodes[node - 1]);
    node = block.nodes.size();
  }
  EXPECT_TRUE(has(refusal("twice.inp", block.abaqus()), "1 cell would stand"));
  // A third cell on a face, and a second one on the same side.
  Block third;
  third.nodes.insert(
      third.nodes.end(),
      {{{0., 3., 0.}}, {{1., 3., 0.}}, {{0., 3., 1.}}, {{1., 3., 1.}}});
  third.cells.push_back({{4, 5, 29, 28, 13, 14, 31, 30}});
  EXPECT_TRUE(has(refusal("three.inp", third.abaqus()), "more than two cells"));
  Block fold;
  fold.cells.erase(fold.cells.begin() + 2, fold.cells.begin() + 4);
  fold.nodes.insert(
      fold.nodes.end(),
      {{{0.2, 0., 0.3}}, {{1., 0., 0.3}}, {{0.2, 0., 0.9}}, {{1., 0., 0.9}}});
  fold.cells.push_back({{28, 29, 5, 4, 30, 31, 14, 13}});
  EXPECT_TRUE(has(refusal("fold.inp", fold.abaqus()), "they overlap"));
}

TEST(MeshChecks, a_bad_corner_warns_and_an_inverted_cell_is_refused)
{
  Block block;
  block.nodes[26] = {{1.6, 1.6, 1.2}};
  const NamedMesh made = read_text("bad.inp", block.abaqus());
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_TRUE(has(made.warnings[0], "1 cell with a corner that is flat or "
                                    "folded, the worst cell 8 at (1600, "))
      << made.warnings[0];
  block.nodes[26] = {{0.9, 0.9, 0.9}};
  EXPECT_TRUE(has(refusal("inside.inp", block.abaqus()),
                  "cell 8 at (1362.5, 1362.5, 1362.5) mm is inverted or flat"));
  block.nodes[26] = {{2e6, 2., 2.}};
  EXPECT_TRUE(
      has(refusal("thin.inp", block.abaqus()), "times as long as wide"));
  block.nodes[26] = {{1e200, 2., 2.}};
  EXPECT_TRUE(has(refusal("far.inp", block.abaqus()), "no place for a body"));
  block.cells[7][6] = block.cells[7][5];
  EXPECT_TRUE(has(refusal("corner.inp", block.abaqus()), "a corner twice"));
  // Mirrored: all cells are listed inside out.
  Block mirrored;
  for (auto &x : mirrored.nodes)
    x[0] = -x[0];
  const NamedMesh turned = read_text("mirrored.inp", mirrored.abaqus());
  EXPECT_NEAR(volume_of(turned), 8., 1e-12);
  EXPECT_TRUE(has(turned.notes[0], "8 cells listed inside out, turned"));
}

TEST(MeshChecks, faces_by_plane)
{
  MeshWish wish;
  wish.unit = 1e-3;
  wish.origin = {{5e-3, 0., 0.}};
  NamedMesh made = read_text("planes.inp",
                             Block().abaqus() + "*Surface, name=corner\n"
                                                "1, S1\n1, S3\n",
                             wish);
  const std::string path = "Bodies/a/Clamped faces";
  for (const std::string text : {"x = 5 mm, z=0", "x = 7 mm"})
    name_planes(made, path, text, false);
  name_planes(made, path, "corner", true);
  EXPECT_NEAR(area_of(made, "x = 5 mm")[0], -4e-6, 1e-18);
  EXPECT_NEAR(area_of(made, "x = 7 mm")[0], 4e-6, 1e-18);
  EXPECT_NEAR(area_of(made, "z=0")[2], -4e-6, 1e-18);
  // Known as before, though the plane has taken some of its faces, and in two
  // planes for symmetry.
  EXPECT_NEAR(area_of(made, "corner")[2], -1e-6, 1e-18);
  EXPECT_NEAR(area_of(made, "corner")[1], -1e-6, 1e-18);
  EXPECT_EQ(find_face_ids(path, "corner", made).size(), 2u);
  EXPECT_NEAR(area_of(made, "0")[2], 1e-6, 1e-18);
  const auto message = [&](const std::string &text)
  {
    try
    {
      name_planes(made, path, text, false);
    }
    catch (const InputError &error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(
      has(message("x = 6.9 mm"), "the nearest that some do is at 7 mm"));
  EXPECT_TRUE(has(message("x = 7 kg"), "is no plane"));
  EXPECT_TRUE(has(message("u = 7 mm"), "is no plane"));
}

TEST(MeshChecks, a_unit_that_cannot_be_meant_is_told)
{
  MeshWish wish;
  const NamedMesh made = read_text("large.inp", Block(10.).abaqus(), wish);
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_TRUE(has(made.warnings[0], "\"Mesh unit\""));
}
} // namespace
