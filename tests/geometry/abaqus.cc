// Abaqus decks: parts, instances, sets and surfaces, or the line that is wrong.
#include "mesh_files.h"

namespace
{
using namespace sabot;

const std::string deck = Block().abaqus();

TEST(Abaqus, parts_and_instances_have_their_places)
{
  const std::string parts = "*Heading\n*Part, name=Plate\n" + deck +
                            "*End Part\n*Part, name=Ball\n" +
                            Block(0.5).abaqus() + "*End Part\n";
  const NamedMesh made = read_text(
      "parts.inp",
      parts + "*Assembly, name=A\n*Instance, name=Plate-1, part=Plate\n"
              "*End Instance\n*Instance, name=Ball-1, part=Ball\n"
              "0., 0., 5.\n*End Instance\n*Instance, name=Ball-2, part=BALL\n"
              " 10., 0., 0.\n 10., 0., 0., 10., 0., 1., 90.\n"
              "*End Instance\n*End Assembly\n");
  EXPECT_EQ(made.mesh.cells.size(), 24u);
  EXPECT_NEAR(volume_of(made), 10., 1e-12);
  EXPECT_NEAR(range_of(made, 2).second, 6., 1e-12);
  // Turned about its own corner by a right angle: x becomes y.
  EXPECT_NEAR(range_of(made, 0).first, 0., 1e-12);
  EXPECT_NEAR(range_of(made, 0).second, 10., 1e-12);
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_TRUE(has(made.warnings[0], "3 pieces that share no node"));

  MeshWish wish;
  wish.part = "Ball-1";
  const NamedMesh ball =
      read_text("parts.inp",
                parts + "*Instance, name=Ball-1, part=Ball\n"
                        "0,0,5\n*End Instance\n"
                        "*Instance, name=Plate-1, part=Plate\n"
                        "*End Instance\n",
                wish);
  EXPECT_NEAR(volume_of(ball), 1., 1e-12);
  EXPECT_NEAR(range_of(ball, 2).first, 5., 1e-12);

  EXPECT_TRUE(has(refusal("parts.inp", parts), "*Instance"));
  EXPECT_TRUE(has(refusal("parts.inp", "*Instance, name=A, part=B\n"),
                  "line 1: there is no part \"B\""));
}

TEST(Abaqus, independent_instances_have_meshes_of_their_own)
{
  const std::string mesh = Block().abaqus();
  const NamedMesh made = read_text(
      "independent.inp",
      "*Part, name=P\n*End Part\n*Assembly, name=A\n"
      "*Instance, name=P-1, part=P\n" +
          mesh + "*End Instance\n*Instance, name=P-2, part=P\n5., 0., 0.\n" +
          mesh +
          "*Nset, nset=low, generate\n1, 9, 1\n*End Instance\n"
          "*Nset, nset=far, instance=P-2\nlow\n*End Assembly\n");
  EXPECT_EQ(made.mesh.cells.size(), 16u);
  EXPECT_NEAR(range_of(made, 0).second, 7., 1e-12);
  EXPECT_EQ(find_face_ids("", "far", made).size(), 1u);
}

TEST(Abaqus, data_may_stand_in_included_files_and_in_any_order)
{
  const std::size_t at = deck.find("*Element");
  const std::string nodes = deck.substr(0, at), elements = deck.substr(at);
  // Numbers alone, the keyword above the include and data behind it.
  const std::size_t line = nodes.find('\n') + 1,
                    last = nodes.rfind('\n', nodes.size() - 2) + 1;
  write_file("numbers.inc", nodes.substr(line, last - line));
  EXPECT_EQ(read_text("included.inp", "*Node, nset=all\n*Include, "
                                      "input=numbers.inc\n" +
                                          nodes.substr(last) + elements)
                .mesh.cells.size(),
            8u);
  EXPECT_TRUE(has(refusal("words.inp", "*Part, name=P\n*Include, "
                                       "input=numbers.inc\n"),
                  "numbers.inc\", line 1: text stands before"));
  // Elements first.
  EXPECT_EQ(read_text("order.inp", elements + nodes).mesh.cells.size(), 8u);
  // A comma too many takes no line of numbers.
  std::string comma = deck;
  comma.replace(comma.find("type=C3D8R"), 10, "type=C3D8R,");
  EXPECT_EQ(read_text("comma.inp", comma).mesh.cells.size(), 8u);
  comma.replace(comma.find("type=C3D8R,"), 11, "type=C3D8R,\n** and\nelset=E");
  EXPECT_EQ(read_text("comma.inp", comma).mesh.cells.size(), 8u);
  // Names in any case.
  MeshWish wish;
  wish.part = "IRON";
  EXPECT_EQ(read_text("case.inp",
                      deck + "*Elset, elset=E\n1, 2\n"
                             "*Solid Section, elset=E, material=iron\n",
                      wish)
                .mesh.cells.size(),
            2u);
  EXPECT_TRUE(has(refusal("wide.inp", "\xff\xfe*" + deck), "UTF-16"));
}

TEST(Abaqus, faces_go_by_surfaces_and_node_sets)
{
  const NamedMesh made = read_text(
      "sets.inp",
      "\xEF\xBB\xBF** a comment\r\n" + Block().abaqus(1001) +
          "*Surface, type=ELEMENT, name=SS5\r\n1001, S1\r\n1002, S1\r\n"
          "1003, S1\n1004, s1\n"
          "*Elset, elset=upper, generate\n1005, 1008, 1\n"
          "*Elset, elset=both\nupper, 1001\n"
          "*Surface, name=TOP\nupper, S2\n"
          "*Nset, nset=left, generate\n1, 25, 3\n"
          "*Nset, nset=edge\n1, 2, 3\n"
          "*Surface, type=NODE, name=left surface\nleft, 1.\n"
          "*Surface, name=skin\nboth,\n"
          "*Surface, name=round, type=REVOLUTION\n0., 0.\n"
          "*Surface Interaction, name=P\n1.,\n*Friction\n0.3,\n");
  EXPECT_EQ(made.mesh.cells.size(), 8u);
  EXPECT_NEAR(area_of(made, "SS5")[2], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "5")[2], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "top")[2], 4., 1e-12);
  EXPECT_NEAR(area_of(made, "left")[0], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "left surface")[0], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "skin")[2], 3., 1e-12);
  const auto message = [&](const std::string &name)
  {
    try
    {
      find_face_ids("Bodies/a/Clamped faces", name, made);
    }
    catch (const InputError &error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(has(message("bottom"), "allowed: skin, SS5 (5), TOP, left"));
  EXPECT_TRUE(has(message("edge"), "no face of the boundary"));
  EXPECT_TRUE(has(message("round"), "from other surfaces or by formula"));
}

TEST(Abaqus, sets_of_an_assembly_belong_to_instances)
{
  const NamedMesh made = read_text(
      "assembly.inp",
      "*Part, name=P\n" + deck +
          "*Nset, nset=low\n1,2,3,4,5,6,7,8,9\n"
          "*Elset, elset=all, generate\n1, 8\n"
          "*Solid Section, elset=all, material=Steel\n,\n*End Part\n"
          "*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n"
          "*Instance, name=P-2, part=P\n0,0,10\n*End Instance\n"
          "*Nset, nset=far, instance=P-2\nlow\n"
          "*Elset, elset=_S_S2, internal, instance=P-2, generate\n5, 8, 1\n"
          "*Surface, type=ELEMENT, name=far top\n_S_S2, S2\n"
          "*Surface, type=NODE, name=named\nP-1.low\n"
          "*Node\n1, 0., 0., 50.\n*End Assembly\n"
          "*Material, name=Steel\n*Elastic\n210000., 0.3\n");
  EXPECT_EQ(made.mesh.cells.size(), 16u);
  EXPECT_NEAR(area_of(made, "low")[2], -8., 1e-12);
  EXPECT_NEAR(area_of(made, "P-1.low")[2], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "far")[2], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "named")[2], -4., 1e-12);
  EXPECT_NEAR(area_of(made, "far top")[2], 4., 1e-12);
  // The reference point belongs to no cell.
  EXPECT_NEAR(range_of(made, 2).second, 12., 1e-12);
  EXPECT_TRUE(has(made.notes.back(), "Steel"));
  EXPECT_TRUE(has(made.notes[0], "*Material, *Elastic"));
}

TEST(Abaqus, includes_and_continued_lines)
{
  write_file("nodes.inc", "*Node\n1, 0,0,0\n2, 1,0,0\n3, 1,1,0\n4, 0,1,0\n"
                          "5, 0,0,1D0\n6, 1,0,+1.\n7, 1.,1.,1.\n8, ,1,1\n");
  const NamedMesh made =
      read_text("cube.inp", "*Include, input=nodes.inc\n*ELEMENT,\n"
                            "TYPE = c3d8 ,\nELSET=EB7\n"
                            "10, 1, 2, 3, 4,\n5, 6, 7, 8\n");
  EXPECT_NEAR(volume_of(made), 1., 1e-15);
  EXPECT_TRUE(has(made.notes.back(), "parts: EB7 (7)"));
  EXPECT_TRUE(has(refusal("loop.inp", "*Include, input=loop.inp\n"), "deeply"));
}

TEST(Abaqus, an_instance_without_end_has_no_members_elsewhere)
{
  const std::string text =
      "*Part, name=P\n" + deck + "*Nset, nset=low, generate\n1, 9, 1\n" +
      "*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n"
      "0., 0., 1.\n*End Instance\n*Instance, name=P-2, part=P\n"
      "9., 0., 0.\n*End part=P\n*Nset, nset=far, instance=P-2\nlow\n"
      "*End Assembly\n";
  const std::string message = refusal("open.inp", text);
  EXPECT_TRUE(has(message, "a member that is not there")) << message;
}

TEST(Abaqus, in_latin_1_is_told_by_line)
{
  // Größe and Stück, as a German Windows saves them.
  const std::string names = "*Nset, nset=St\xfc"
                            "ck\n1, 2\n";
  const std::string message = refusal("latin.inp", "*Heading\n" + deck + names);
  EXPECT_TRUE(has(message, "latin.inp\", line 39: the byte 0xfc after "
                           "\"*Nset, nset=St\" is not UTF-8"))
      << message;
  EXPECT_TRUE(has(refusal("latin.inp", deck + "*Elset, elset=a\n1,\n"
                                              "*Surface, name=s\nGr\xf6\xdf"
                                              "e, S1\n"),
                  "line 41: the byte 0xf6 after \"Gr\""));
  // In comments and headings it does no harm; the first is told.
  const NamedMesh made = read_text("latin.inp", "** Gr\xf6\xdf"
                                                "e\n*Heading\nStu\xdf\n" +
                                                    deck);
  EXPECT_EQ(made.mesh.cells.size(), 8u);
  EXPECT_TRUE(has(made.notes[0], "latin.inp\", line 1: the byte 0xf6 after "
                                 "\"** Gr\" is not UTF-8"))
      << made.notes[0];
  for (std::size_t i = 1; i < made.notes.size(); ++i)
    EXPECT_FALSE(has(made.notes[i], "UTF-8")) << made.notes[i];
}

TEST(Abaqus, says_which_line_is_wrong)
{
  const std::string nodes = "*Node\n1, 0, 0, 0\n";
  const auto bad = [](const std::string &text)
  { return refusal("bad.inp", text); };
  EXPECT_TRUE(has(bad("1, 2, 3\n"), "line 1: text stands before"));
  EXPECT_TRUE(has(bad(nodes + "2, a, 0, 0\n"), "line 3: entry 2 is no number"));
  EXPECT_TRUE(
      has(bad(nodes + "1, 1, 0, 0\n"), "line 3: node 1 is there twice"));
  EXPECT_TRUE(has(bad(nodes + "*Element, type=C3D8\n1, 1, 1\n"),
                  "line 4: element 1 of type C3D8 has 2 nodes, not 8"));
  EXPECT_TRUE(has(bad(nodes + "*Element, type=C3D8\n1, 1,1,1,1,1,1,1,99\n"),
                  "line 4: element 1 has the node \"99\""));
  EXPECT_TRUE(has(bad(nodes + "*Ngen\n1, 2, 1\n"), "line 3: *Ngen"));
  EXPECT_TRUE(
      has(bad(nodes + "*Nset, nset=a\nb\n"), "line 4: there is no set"));
  EXPECT_TRUE(has(bad(nodes + "*Nset, nset=a, generate\n1, 2000000000, 0\n"),
                  "line 4: GENERATE"));
  EXPECT_TRUE(has(bad(nodes), "no elements that are hexahedra"));
  EXPECT_TRUE(has(bad(nodes + "*Element, type=C3D4, elset=t\n1, 1,1,1,1\n"),
                  "line 3: elements of type C3D4"));
  EXPECT_TRUE(has(bad(""), "it is empty"));
  // Bytes that are no characters come into no message.
  EXPECT_TRUE(has(bad(nodes + "*Nset, nset=a\n\x02\x01z\n"), "\"??z\""));
  EXPECT_TRUE(has(bad(nodes + "*Nset, nset=a\n\x01\xE4z\n"),
                  "line 4: the byte 0xe4 after \"?\""));
}
} // namespace
